"""How `index` has boards looked at: by a pipeline that is loaded when one is wanted."""

from collections.abc import Mapping, Sequence
from enum import StrEnum
from typing import TYPE_CHECKING

from pipelines import plural
from pipelines.cli.launch import ended, patient, told
from pipelines.console import Voice, errors, fail, hushed
from pipelines.stopping import Stopped, heeded

if TYPE_CHECKING:  # both are slow to load
    from pipelines.index import Ask, Heard


class Whose(StrEnum):
    """Whose boards are read."""

    silent = "silent"
    all = "all"
    none = "none"


def asking(
    city: str,
    whose: Whose,
    voice: Voice,
    *,
    models: str,
    beam: Sequence[str],
    dry: bool = False,
) -> "Ask | None":
    """Say whose boards are looked at; Beam's options are looked at now.

    `dry`, of boards that nobody looked at yet nothing is told, and nothing is written.
    """
    from pipelines.index import Ask

    processes = 1
    if beam:
        options = told(city, models=models, beam=beam)
        from pipelines.build import processes_here

        processes = processes_here(options)
    if whose is Whose.none:
        return None

    def boards(root: str, names: Sequence[str]) -> "Mapping[str, Heard]":
        options = told(city, models=models, beam=beam)
        from pipelines import build
        from pipelines.models import Unlocked

        if dry:
            return build.boards_read(options, root, names)
        words = f"looking at the boards of {plural.of(len(names), 'photo')}"
        voice.say("boards", words, photos=len(names))
        plain = (Unlocked, build.Lost, build.Unrun)
        try:
            with heeded(patient), hushed(errors, plain=(*plain, OSError, Stopped)):
                return build.boards(options, root, names)
        except Stopped as problem:
            raise ended(problem) from problem
        except plain as problem:
            raise fail(str(problem)) from problem

    return Ask(boards, whose.value, processes)
