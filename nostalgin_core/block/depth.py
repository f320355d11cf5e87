"""How long a ring's sides are: by their own lots, and by how deep the block is there.

A lot that runs through from street to street is as deep as the block. Else the usual
lot of one street and the usual lot of the other stand back to back.
"""

from collections.abc import Mapping, Sequence
from statistics import median
from typing import Final

from nostalgin_core.block import outline
from nostalgin_core.block.pieces import Piece, relative_sd

THROUGH: Final = (1.75, 2.5)  # times the usual depth: such a lot runs through
DEEP_SD: Final = 0.05  # lots are measured to the inch, what lies between is not
ALIKE: Final = 0.85  # of the deepest: through-lots differ by no more


def measured(
    sides: Sequence[Sequence[Piece]], leaning: Mapping[int, float | None]
) -> list[outline.Measured]:
    """Sum each side's widths, and their variances.

    Where a side's own lots do not fill the block's depth between the streets on either
    side of it, that is its length; one that leans is not square to them.
    """
    widths = [sum(piece.width_m for piece in side) for side in sides]
    deep = [0.0] * len(sides)
    if len(sides) == 4:
        deep = [0.0 if i in leaning else one for i, one in enumerate(depths(sides))]
    totals = [max(pair) for pair in zip(widths, deep, strict=True)]
    mean_m = sum(totals) / sum(total > 0 for total in totals)
    free = {side for side in range(len(sides)) if len(sides) != 4 or side in leaning}
    free -= {side for side, lean in leaning.items() if lean is not None}
    free_sd = outline.FREE_SD_RAD if len(sides) == 4 else outline.POLYGON_SD_RAD
    made = []
    for index, heading in enumerate(outline.nominal_headings(len(sides))):
        filled = widths[index] >= totals[index]
        sd = relative_sd(sides[index]) if sides[index] else outline.UNKNOWN_SD
        made.append(
            outline.Measured(
                length_m=totals[index] or mean_m,
                squeeze_sd=sd if filled else DEEP_SD,
                stretch_sd=DEEP_SD if deep[index] else None,
                heading_rad=float(heading) + (leaning.get(index) or 0.0),
                heading_sd_rad=free_sd if index in free else 0.0,
            )
        )
    return made


def depths(sides: Sequence[Sequence[Piece]]) -> list[float]:
    """Tell for each of four sides how deep the block is along it; 0: nothing tells."""
    across = [_between(sides[side], sides[(side + 2) % 4]) for side in (0, 1)]
    return [across[1 - side % 2] for side in range(4)]


def _between(a: Sequence[Piece], b: Sequence[Piece]) -> float:
    """Find the depth between two sides, in metres.

    Lots at the ends may be measured along the other street, and do not count.
    """
    inner = [[one.depth_m for one in side[1:-1] if one.depth_listed] for side in (a, b)]
    every = [*inner[0], *inner[1]]
    if not every:
        return 0.0
    through = [one for one in every if one > ALIKE * max(every)]
    usual = [one for one in every if one <= ALIKE * max(every)]
    if usual and THROUGH[0] <= median(through) / median(usual) <= THROUGH[1]:
        return median(through)
    if not all(inner):
        return 0.0
    return median(inner[0]) + median(inner[1])
