"""What a stage's results depend on beside its input: its code and its parameters.

    <code version>-<hash of the parameters and of the network>

The code version is raised by hand when a stage's results change; a comment or a rename
must not send an archive back to its first photo. The parameters are the defaults in the
signatures of the stage's functions, so that a changed default can't be forgotten.
"""

import inspect
import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

from nostalgin_core import inpaint, matte, photo, rectify, segment
from pipelines.models import Models
from pipelines.store import ARTIFACTS, key_of

CODE: Final = {"segment": 1, "matte": 1, "rectify": 1, "inpaint": 1, "block": 1}
FUNCTIONS: Final[dict[str, tuple[Callable[..., Any], ...]]] = {
    "segment": (photo.decode, segment.segment),
    "matte": (matte.matte,),
    "rectify": (rectify.rectify,),
    "inpaint": (inpaint.inpaint,),
    "block": (),
}
NETWORK: Final = {"segment": "segment", "inpaint": "inpaint"}


def parameters(*functions: Callable[..., Any]) -> str:
    """Write the defaults of functions as text, in the order of the signatures."""
    found = [
        [function.__name__, name, repr(one.default)]
        for function in functions
        for name, one in inspect.signature(function).parameters.items()
        if one.default is not inspect.Parameter.empty
    ]
    return json.dumps(found)


def version(stage: str, models: Models) -> str:
    """Name the version of a stage as it is now.

    Raises:
        Unlocked: if the stage's network has no lock.
    """
    network = models.sha256(NETWORK[stage]) if stage in NETWORK else ""
    return f"{CODE[stage]}-{key_of(parameters(*FUNCTIONS[stage]), network)[:8]}"


@dataclass(frozen=True)
class Versions:
    """The versions of all stages in one run, and so the names of all artifacts."""

    segment: str
    matte: str
    rectify: str
    inpaint: str
    block: str

    def key(self, stage: str, *made_from: str) -> str:
        """Make an artifact's key from the keys of what it is made from."""
        return key_of(stage, getattr(self, stage), *made_from)

    def path(self, stage: str, key: str) -> str:
        """Name an artifact, relative to the city folder."""
        return f"{ARTIFACTS}/{stage}/{getattr(self, stage)}/{key[:2]}/{key}.parquet"

    def segment_key(self, sha256: str) -> str:
        """Key what the network found in a photo."""
        return self.key("segment", sha256)

    def matte_key(self, sha256: str) -> str:
        """Key the matted facades of a photo."""
        return self.key("matte", self.segment_key(sha256))

    def rectify_key(self, sha256: str) -> str:
        """Key the elevations of a photo."""
        return self.key("rectify", self.matte_key(sha256))

    def inpaint_key(self, sha256: str, facade: int) -> str:
        """Key one finished elevation."""
        return self.key("inpaint", self.rectify_key(sha256), str(facade))


def versions(models: Models) -> Versions:
    """Name the versions of all stages as they are now."""
    return Versions(**{stage: version(stage, models) for stage in CODE})
