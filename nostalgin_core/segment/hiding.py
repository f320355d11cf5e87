"""What hides fronts is told from what is painted on them, and gets its full size.

Two habits of the network's that its labels don't share. It calls signs that are painted
or laid flat on a front a thing before it: what it is unsure of, and what lies nearly
whole inside one front, belongs to the front; posts and fences reach the street, and
hoardings are found with more confidence. And it outlines people and cars too narrowly,
since its texels are coarse beside them: where it gives them 0.3, they are as likely
there as not.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from nostalgin_core.records import Category, Instance

SURE: Final = 0.4  # score from which a thing on a front stands before it
WITHIN: Final = 0.85  # of its pixels: at 0.7, posts are lost
NARROW: Final[tuple[Category, ...]] = ("person", "vehicle")
EVEN: Final = 0.3  # the probability that means one half


def hiding(
    found: Sequence[Instance],
    *,
    sure: float = SURE,
    within: float = WITHIN,
    even: float = EVEN,
) -> tuple[Instance, ...]:
    """Drop what is painted on fronts; people and cars grow to their full size."""
    fronts = [one for one in found if one.category == "facade"]
    return tuple(
        widened(one, even=even) if one.category in NARROW else one
        for one in found
        if one.category != "other"
        or one.score >= sure
        or all(share_inside(one, front) < within for front in fronts)
    )


def widened(one: Instance, *, even: float = EVEN) -> Instance:
    """Raise an instance's probability p to p^q, so that `even` becomes one half.

    0 and 1 stay what they are, and a likelier pixel stays likelier.
    """
    power = np.float32(np.log(0.5) / np.log(even))
    return replace(one, probability=np.power(one.probability, power))


def share_inside(one: Instance, front: Instance) -> float:
    """Return the share of a thing's pixels that are likelier the front's than not."""
    x0, y0 = max(one.box.x0, front.box.x0), max(one.box.y0, front.box.y0)
    x1, y1 = min(one.box.x1, front.box.x1), min(one.box.y1, front.box.y1)
    mask = one.probability > 0.5
    if x1 <= x0 or y1 <= y0 or not mask.any():
        return 0.0
    here, there = (
        i.probability[y0 - i.box.y0 : y1 - i.box.y0, x0 - i.box.x0 : x1 - i.box.x0]
        > 0.5
        for i in (one, front)
    )
    return np.count_nonzero(here & there) / np.count_nonzero(mask)
