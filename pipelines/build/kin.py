"""Workers make what they are asked for, or the run ends: they are the same build.

What a worker makes is kept under the versions of whoever asks. Of another build, or of
other networks, it would pass for what it is not.
"""

from typing import Final, TypeVar

from pipelines import index
from pipelines.build.bench import Bench
from pipelines.store.versions import CODE, Versions

Ref = TypeVar("Ref")
REMEDY: Final = (
    "install the same Nostalgin for the command and for all workers, and give --models "
    "only where all of them have that folder"
)


class Strange(RuntimeError):  # noqa: N818 - it reads as what it is about
    """A worker of another build than whoever asks it."""


def akin(ref: Ref, bench: Bench) -> Ref:
    """Pass an element on, if this process would make of it what was asked for.

    Raises:
        Strange: if it would not.
    """
    mark = index.watermark_sha256(bench.mark)
    own, asked = Versions.present(bench.models, mark=mark), bench.versions
    others = [one for one in CODE if getattr(own, one) != getattr(asked, one)]
    if others:
        raise Strange(f"this worker would do {', '.join(others)} otherwise: {REMEDY}")
    return ref
