"""How one block may stand to another that has a front on the same street.

- They face each other over it, if the house numbers are odd on one and even on the
  other; where they also share a crossing, those corners are put opposite.
- They follow one another along it, if both are odd or both even: by so many metres as
  their house numbers are apart, at the density of numbers on these very sides.

A block asks only those next to it by house number (`pairs`): of each parity so many
below and above it. So the ways of a whole city are as many as its blocks, times a
number that does not grow, and finding them is sorting.
"""

import bisect
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from nostalgin_core.address import STREET_M, plain_name, street_width
from nostalgin_core.city.plot import Border, Move, Plot, about, heading, length, middle

NEAREST = 2  # of each parity, below a side and above it
Widths = Mapping[str, float]  # of streets, by their plain names, in metres
Pair = tuple[int, float, int, int, int, int]  # rank, numbers apart, blocks, borders


def pairs(plots: Sequence[Plot]) -> list[Pair]:
    """List which sides of which blocks may stand to each other, the surest first.

    A pair is (rank, house numbers between, block, other block, side, other side).
    """
    found = set()
    for sides in on_streets(plots).values():
        for parity in (0, 1):
            those = [one for one in sides if one[1].parity == parity]
            middles = [_mean(border) for _, border, *_ in those]
            for block, border, side in sides:
                at = bisect.bisect_left(middles, _mean(border))
                near = those[max(0, at - NEAREST) : at + NEAREST + 1]  # itself, too
                for other, theirs, there in near:
                    if other != block:
                        rank = _rank(border, theirs)
                        gap = _apart(border, theirs)
                        found.add((rank, gap, block, other, side, there))
                        found.add((rank, gap, other, block, there, side))
    return sorted(found)


def on_streets(plots: Sequence[Plot]) -> dict[str, list[tuple[int, Border, int]]]:
    """List each street's numbered sides by their house numbers."""
    on: dict[str, list[tuple[int, Border, int]]] = defaultdict(list)
    for block, one in enumerate(plots):
        for side, border in enumerate(one.borders):
            if border.numbers is not None:
                on[border.street].append((block, border, side))
    for sides in on.values():
        sides.sort(key=lambda one: (_mean(one[1]), one[0], one[2]))
    return on


def ways(mine: Border, theirs: Border, widths: Widths) -> Iterator[Move]:
    """Give the moves of a block whose side is `mine`, so that it stands to the other's.

    `theirs` is where it lies already, `mine` in its block's own frame.
    """
    if mine.parity != theirs.parity:
        yield _opposite(mine, theirs, widths)
    else:
        yield from _beyond(mine, theirs)


def width_of(street: str, widths: Widths) -> float:
    """Tell a street's width in metres, as measured or by its name."""
    return widths.get(plain_name(street)) or street_width(street)


def rise(border: Border) -> int:
    """Tell whether numbers rise along a border: 1, -1, or 0 where there is but one."""
    return int(np.sign(border.numbers[1] - border.numbers[0])) if border.numbers else 0


def _rank(mine: Border, theirs: Border) -> int:
    """Rank a way: opposite at a crossing, opposite, further along, opposite far off."""
    if mine.parity == theirs.parity:
        return 2
    if _at_start(mine, theirs) or _at_end(mine, theirs):
        return 0
    return 1 if _apart(mine, theirs) == 0 else 3


def _at_start(mine: Border, theirs: Border) -> bool:
    return bool(mine.before) and mine.before == theirs.after


def _at_end(mine: Border, theirs: Border) -> bool:
    return bool(mine.after) and mine.after == theirs.before


def _mean(border: Border) -> float:
    return sum(border.numbers) / 2 if border.numbers else 0.0


def _apart(mine: Border, theirs: Border) -> float:
    """Count the house numbers between two sides; 0 where they overlap."""
    if mine.numbers is None or theirs.numbers is None:
        return 0.0
    a, b = sorted([sorted(mine.numbers), sorted(theirs.numbers)])
    return float(max(0, b[0] - a[1] - 1))


def _opposite(mine: Border, theirs: Border, widths: Widths) -> Move:
    ahead = (theirs.end_m - theirs.start_m) / length(theirs)
    gap = width_of(theirs.street, widths) * np.array([ahead[1], -ahead[0]])
    at_start, at_end = _at_start(mine, theirs), _at_end(mine, theirs)
    if at_start == at_end:
        pivot, target = middle(mine), middle(theirs)
        if _apart(mine, theirs):
            target = target + _along(mine, theirs) * ahead
    elif at_start:
        pivot, target = mine.start_m, theirs.end_m
    else:
        pivot, target = mine.end_m, theirs.start_m
    return about(heading(theirs) + np.pi - heading(mine), pivot, target + gap)


def _beyond(mine: Border, theirs: Border) -> Iterator[Move]:
    along = _along(mine, theirs)
    if along:
        least = (length(mine) + length(theirs)) / 2 + STREET_M
        along = np.copysign(max(abs(along), least), along)
        target = middle(theirs) + along * (theirs.end_m - theirs.start_m) / length(
            theirs
        )
        yield about(heading(theirs) - heading(mine), middle(mine), target)


def _along(mine: Border, theirs: Border) -> float:
    """Tell how far along their side mine lies, in metres, by the house numbers."""
    facing = -1 if mine.parity != theirs.parity else 1
    rises = facing * rise(mine) or rise(theirs)
    densities = [
        length(one) / abs(one.numbers[1] - one.numbers[0])
        for one in (mine, theirs)
        if one.numbers and one.numbers[0] != one.numbers[1]
    ]
    if not rises or not densities:
        return 0.0
    return rises * (_mean(mine) - _mean(theirs)) * float(np.mean(densities))
