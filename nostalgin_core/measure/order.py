"""Do fronts stand along their streets as their house numbers run?

Lots of one block that have numbers of one parity on one street stand on one side of it.
Walked round the block their numbers must rise, or fall, without one going back; where
a block has two rings on one street, the numbers of one ring must all lie before those
of the other. Which way they run is told by the street's other side, on the next block:
two rings that are both walked with the block on the left hand pass it in opposite
directions.
"""

from bisect import bisect_right
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from nostalgin_core.address import house_numbers
from nostalgin_core.records import Front

FEWEST: Final = 2  # lots of a side, from which it runs some way

Side = tuple[str, str, int]  # block, street, parity


@dataclass(frozen=True)
class Order:
    """How many lots of one block stand as their numbers run."""

    block: str
    rings: int
    lots: int  # that have a number and a street
    right: int
    wrong: tuple[str, ...]  # lots that would have to move, at the least
    unnumbered: int


@dataclass(frozen=True)
class Numbered:
    """A lot, with its place in the walk and its house number."""

    lot: str
    ring: int
    number: int


def orders(
    fronts: Sequence[Front], addresses: Mapping[tuple[str, str], Sequence[str]]
) -> list[Order]:
    """Compare each block's fronts with what a true list says of their lots.

    `addresses` are those of block and lot, each as "561-565 7 Avenue"; a front whose
    street and lot are on none of them has no number.
    """
    made = []
    blocks = dict.fromkeys(one.block for one in fronts)
    along = sides(fronts, addresses)
    for block in blocks:
        own = {side: some for side, some in along.items() if side[0] == block}
        wrong = [one for some in own.values() for one in misplaced(some)]
        numbered = sum(map(len, own.values()))
        every = [one for one in fronts if one.block == block]
        rings = len({one.ring for one in every})
        silent = len(every) - numbered
        right = numbered - len(wrong)
        made.append(Order(block, rings, numbered, right, tuple(wrong), silent))
    return made


def sides(
    fronts: Iterable[Front], addresses: Mapping[tuple[str, str], Sequence[str]]
) -> dict[Side, list[Numbered]]:
    """Part fronts that have numbers by the sides of their streets, as one walks."""
    made: dict[Side, list[Numbered]] = defaultdict(list)
    for one in sorted(fronts, key=lambda one: (one.block, one.ring, one.rank)):
        said = addresses.get((one.block, one.lot), ())
        for address in said:
            ends = house_numbers(address)
            if ends is not None and one.street and address.endswith(one.street):
                side = (one.block, one.street, ends[0] % 2)
                made[side].append(Numbered(one.lot, one.ring, ends[0]))
                break
    return made


def misplaced(side: Sequence[Numbered]) -> list[str]:
    """Name the fewest lots of one side without which all others stand in order."""
    best: list[int] = []
    rings = list(dict.fromkeys(one.ring for one in side))
    for turned in (rings, rings[::-1]):
        walk = [i for r in turned for i, one in enumerate(side) if one.ring == r]
        for sign in (1, -1):
            kept = longest([sign * side[i].number for i in walk])
            some = [walk[place] for place in kept]
            best = max(best, some, key=len)
    return [one.lot for i, one in enumerate(side) if i not in best]


def longest(numbers: Sequence[int]) -> list[int]:
    """Find the places of a longest run that never falls."""
    ends: list[int] = []
    places: list[int] = []
    before: list[int] = []
    for place, number in enumerate(numbers):
        at = bisect_right(ends, number)
        ends[at : at + 1] = [number]
        before.append(places[at - 1] if at else -1)
        places[at : at + 1] = [place]
    run = []
    last = places[-1] if places else -1
    while last >= 0:
        run.append(last)
        last = before[last]
    return run[::-1]


def opposite(along: Mapping[Side, Sequence[Numbered]]) -> tuple[int, int]:
    """Count streets with lots on both sides: those whose sides run opposite, and all.

    A side runs as most of its steps from lot to lot do; one that runs no way tells
    nothing.
    """
    ways: dict[str, dict[int, int]] = defaultdict(dict)
    for (_, street, parity), some in along.items():
        way = sum(
            (b.number > a.number) - (b.number < a.number)
            for a, b in pairwise(some)
            if a.ring == b.ring
        )
        if len(some) >= FEWEST and way:
            ways[street][parity] = ways[street].get(parity, 0) + (1 if way > 0 else -1)
    both = [one for one in ways.values() if len(one) == 2]
    return sum(one[0] * one[1] < 0 for one in both), len(both)
