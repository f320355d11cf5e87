"""Which house numbers a block lists on each side of its streets, and where gaps are.

A *face* is one parity of one street. A number is *near* a face if it lies within half a
block front of two lots of it, or of the only other one. It has its *gap* there if it is
near and no other lot has it. That speaks *against* a street, that two other lots have
numbers there and a number is near to none.
"""

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from nostalgin_core.catalogue.spots import Spot, folded

NEAR: Final = 50.0  # numbers: a front of 800 feet has a hundred
WITNESSES: Final = 2  # other lots: one may itself be a slip

Numbers = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Faces:
    """The numbers of each street and parity, in order, with the place of each spot."""

    by_face: dict[tuple[str, int], list[tuple[float, float, int]]]
    named: dict[str, str]  # streets, as they are written
    lots: tuple[str, ...]  # of the spots
    frequent: tuple[str, ...]  # streets on which several lots have numbers

    def fits(self, street: str, numbers: Numbers, own: int) -> bool:
        """Tell whether numbers have their gap on a street, but for the spot `own`."""
        return self.near(street, numbers, own) > 0 and not self.taken(
            street, numbers, own
        )

    def taken(self, street: str, numbers: Numbers, own: int) -> list[int]:
        """List the spots that have some of these numbers."""
        face = self._face(street, numbers)
        place = bisect_left(face, (numbers[0], -1.0, -1))
        some = face[max(place - 3, 0) : place]
        while place < len(face) and face[place][0] <= numbers[1]:
            some.append(face[place])
            place += 1
        return [
            index
            for low, high, index in some
            if low <= numbers[1] and numbers[0] <= high and self._other(index, own)
        ]

    def near(self, street: str, numbers: Numbers, own: int) -> int:
        """Count up to two lots of a face that numbers are near to.

        0 where only one is and the face has others, which are far.
        """
        face = self._face(street, numbers)
        place = bisect_left(face, (numbers[0], -1.0, -1))
        some = face[max(place - 3, 0) : place + 3]
        beside = [one for one in some if self._other(one[2], own)]
        close = sum(
            low - NEAR <= numbers[1] and numbers[0] <= high + NEAR
            for low, high, _ in beside
        )
        return min(close, WITNESSES) if close >= min(WITNESSES, len(beside)) else 0

    def against(self, street: str, numbers: Numbers, own: int) -> int:
        """Count up to two lots of a street that are far from numbers on it."""
        if any(self.near(street, one, own) for one in (numbers, *flipped(numbers))):
            return 0
        others = {
            self.lots[one[2]]
            for parity in (0, 1)
            for one in self.by_face.get((folded(street), parity), [])[:3]
            if self._other(one[2], own)
        }
        return min(len(others), WITNESSES)

    def _other(self, index: int, own: int) -> bool:
        """Tell whether a spot is of another lot than the spot `own`."""
        return own < 0 or self.lots[index] != self.lots[own]

    def _face(self, street: str, numbers: Numbers) -> list[tuple[float, float, int]]:
        return self.by_face.get((folded(street), int(numbers[0]) % 2), [])


def faces(some: Sequence[Spot]) -> Faces:
    """Sort the numbers of a block's spots by street and parity."""
    by_face: dict[tuple[str, int], list[tuple[float, float, int]]] = defaultdict(list)
    for index, spot in enumerate(some):
        if spot.numbers is not None and spot.street:
            face = (folded(spot.street), int(spot.numbers[0]) % 2)
            by_face[face].append((*spot.numbers, index))
    named = {folded(one.street): one.street for one in reversed(some)}
    return Faces(
        {face: sorted(own) for face, own in by_face.items()},
        named,
        tuple(one.lot for one in some),
        tuple(dict.fromkeys(named[s] for (s, _), own in by_face.items() if own[1:])),
    )


def flipped(numbers: Numbers) -> list[Numbers]:
    """List the numbers across the street that are one less and one more."""
    low, high = numbers
    return [(low + step, high + step) for step in (-1, 1) if low + step > 0]
