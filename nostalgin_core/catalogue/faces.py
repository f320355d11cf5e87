"""Which house numbers a block lists on each side of its streets, and where gaps are.

A *face* is one parity of one street. A number fits a street if it has its gap there: no
other lot has it, and it lies between the face's numbers or not far beyond them.
"""

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from nostalgin_core.catalogue.spots import Spot, folded

BEYOND: Final = 24.0  # numbers: the corner lots that a list leaves out
SHARE: Final = 0.25  # or of the face's own numbers

Numbers = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Faces:
    """The numbers of each street and parity, in order, with the place of each spot."""

    by_face: dict[tuple[str, int], list[tuple[float, float, int]]]
    named: dict[str, str]  # streets, as they are written

    def fits(self, street: str, numbers: Numbers, own: int) -> bool:
        """Tell whether numbers have their gap on a street, but for the spot `own`.

        Where there is no such face, or none but of the spot itself, nothing fits.
        """
        return bool(self._near(street, numbers, own)) and not self.taken(
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
            if index != own and low <= numbers[1] and numbers[0] <= high
        ]

    def _near(self, street: str, numbers: Numbers, own: int) -> bool:
        """Tell whether numbers lie within a face's or not far beyond."""
        face = self._face(street, numbers)
        lows = [one for one in (*face[:2], *face[-2:]) if one[2] != own]
        if not lows:
            return False
        least, most = lows[0][0], max(one[1] for one in lows)
        slack = max(BEYOND, SHARE * (most - least))
        return least - slack <= numbers[0] and numbers[1] <= most + slack

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
    return Faces({face: sorted(own) for face, own in by_face.items()}, named)


def flipped(numbers: Numbers) -> list[Numbers]:
    """List the numbers across the street that are one less and one more."""
    low, high = numbers
    return [(low + step, high + step) for step in (-1, 1) if low + step > 0]
