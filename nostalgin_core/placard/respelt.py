"""Boards of another archive are spelt anew, as those that `joined` knows.

    a line     LOT 5 BLK 993
    pattern    LOT ?(?P<lot>[0-9]+) BLK ?(?P<block>[0-9]+)
    becomes    993-5

Then a reader's slips cost what they cost on any board. A line that the pattern is not
found in is none of a board.
"""

from collections.abc import Sequence
from typing import Final

from nostalgin_core.expression import found
from nostalgin_core.placard import misread
from nostalgin_core.placard.joined import Line, Look

WANTED: Final = ("block", "lot")


def respelt(looks: Sequence[Look], pattern: str) -> tuple[Look, ...]:
    """Spell the lines of looks anew in which a pattern is found; drop the others.

    The pattern meets capitals, figures, single spaces and dashes (`misread.cleaned`).

    Raises:
        ValueError: if it is no pattern, or has no groups `block` and `lot`.
    """
    return tuple(
        Look(tuple(new for line in one.lines if (new := anew(line, pattern))))
        for one in looks
    )


def anew(line: Line, pattern: str) -> Line:
    """Spell one line anew; nothing, if it is of no board."""
    told = found(pattern, misread.cleaned(" ".join(line)), WANTED)
    if told is None or not all(told.values()):
        return ()
    return (f"{told['block']}-{told['lot']}",)
