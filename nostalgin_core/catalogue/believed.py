"""On which street a lot is believed to stand, whatever one row says.

Three witnesses speak: the street that is listed, the house number, which is near to the
numbers of some streets and not of others, and the lots before and after. A street is
set aside where the other two are against it: the number has its gap on the neighbours'
street, and is not near to any on its own. One witness may be a slip itself, so that it
takes two lots of a street to draw another there, or two of its own to drive it away.
Where a number fits no street, and the lot stands where a side must be between two
parallel streets, it stands on a side of its own.
"""

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace

from nostalgin_core.catalogue.faces import WITNESSES, Faces, faces, flipped
from nostalgin_core.catalogue.spots import Spot, family, folded

UNKNOWN = "an unknown street"
Doubts = list[tuple[Spot, str]]


def believed(some: Sequence[Spot]) -> tuple[list[Spot], Doubts]:
    """Give each of a block's spots, in order of lot, the street it stands on.

    Where no lot has a street all is left as it is. A lot that comes to stand twice on
    one street is left once.
    """
    known = faces(some)
    anchors = [index for index, one in enumerate(some) if one.street and not one.split]
    anchors = anchors or [index for index, one in enumerate(some) if one.street]
    if not anchors:
        return list(some), []
    twins = _twins(some, known)
    lone = len({folded(some[index].street) for index in anchors}) == 1
    placed, doubts = [], []
    for index, spot in enumerate(some):
        at = _At(index, spot, *_neighbours(some, anchors, index))
        if index in twins:
            twin = twins[index]
            street, why = twin.street, f"row {twin.row} has that number there"
        elif not spot.street:
            street, why = _without_street(at, known)
        else:
            street, why = (spot.street, "") if lone else _street(at, known)
        numbers = spot.numbers
        if folded(street) != folded(spot.street):
            doubts.append((spot, why))
            if numbers and spot.street and not known.fits(street, numbers, index):
                numbers = None
        same = street == spot.street and numbers == spot.numbers
        placed.append(spot if same else replace(spot, street=street, numbers=numbers))
    return _once(some, placed), doubts


@dataclass(frozen=True, slots=True)
class _At:
    """A spot, and the streets of the lots beside it."""

    index: int
    spot: Spot
    before: str
    after: str
    split: tuple[str, ...]  # of lots beside it that were split from others

    @property
    def near(self) -> list[str]:
        return list(dict.fromkeys([self.before, self.after]))

    @property
    def amid(self) -> bool:
        """Tell whether both lots beside it stand on one street."""
        return folded(self.before) == folded(self.after) and not self.spot.split

    @property
    def numbers(self) -> tuple[float, float]:
        return self.spot.numbers or (0.0, 0.0)


def _neighbours(
    some: Sequence[Spot], anchors: Sequence[int], index: int
) -> tuple[str, str, tuple[str, ...]]:
    """Find the streets of the lots before and after that have one, round the block."""
    place = bisect_left(anchors, index)
    own = place < len(anchors) and anchors[place] == index
    before = some[anchors[place - 1]]
    after = some[anchors[(place + own) % len(anchors)]]
    split = [one.street for one in some[max(index - 1, 0) : index + 2] if one.split]
    return before.street, after.street, tuple(split)


def _street(at: _At, known: Faces) -> tuple[str, str]:
    """Choose a spot's street, and say why if it is not the listed one."""
    listed, own = at.spot.street, folded(at.spot.street)
    beside = f"the lots before and after it stand on {at.before}"
    if at.spot.numbers is None:
        return (at.before, beside) if at.amid else (listed, "")
    if known.near(listed, at.numbers, at.index) or (
        at.amid and own == folded(at.before)
    ):
        return listed, ""
    against = known.against(listed, at.numbers, at.index)
    gap = _gap(at, known, least=WITNESSES - against)
    if gap:
        return gap, f"its number has its gap on {gap}"
    if against == WITNESSES:
        return (at.before, beside) if at.amid else _nowhere(at)
    return listed, ""


def _nowhere(at: _At) -> tuple[str, str]:
    """Choose the street of a lot whose number fits none of its block."""
    parallel = family(at.before) == family(at.after) != ""
    if parallel and not at.spot.split:
        return UNKNOWN, f"its number fits no street between {' and '.join(at.near)}"
    if folded(at.spot.street) in map(folded, at.near):
        return at.spot.street, ""
    return at.before, "its number fits no street of its block"


def _gap(at: _At, known: Faces, *, least: int) -> str:
    """Find another street where a number has its gap, the neighbours' streets first.

    Farther away it takes two witnesses, and a number that is not just across its own.
    """
    near = [*at.near, *at.split]
    listed = at.spot.street
    across = any(known.near(listed, one, at.index) for one in flipped(at.numbers))
    for street in [*near, *(() if across else known.frequent)]:
        witnesses = max(least, 1) if street in near else WITNESSES
        if (
            folded(street) != folded(listed)
            and known.fits(street, at.numbers, at.index)
            and known.near(street, at.numbers, at.index) >= witnesses
        ):
            return street
    return ""


def _without_street(at: _At, known: Faces) -> tuple[str, str]:
    """Place a lot that names no street: where its number fits, or by its neighbours."""
    gaps = [
        one
        for one in at.near
        if at.spot.numbers and known.fits(one, at.numbers, at.index)
    ]
    street = (gaps or at.near)[0]
    why = "where its number has its gap" if gaps else "by the lot before it"
    return street, f"it names no street, and is placed on {street} {why}"


def _twins(some: Sequence[Spot], known: Faces) -> dict[int, Spot]:
    """Find the spots whose lot has the same number on another street with better right.

    That is, in more rows; or near to the numbers there, and not on its own.
    """
    same: dict[tuple[str, object], list[int]] = defaultdict(list)
    for index, spot in enumerate(some):
        if spot.numbers and spot.street:
            same[spot.lot, spot.numbers].append(index)
    better = {}
    for own in same.values():
        if len(own) < 2:
            continue

        def right(index: int) -> tuple[int, int, int]:
            spot = some[index]
            near = known.near(spot.street, spot.numbers or (0.0, 0.0), index)
            return spot.rows, near, -spot.row

        best = max(own, key=right)
        better |= {index: some[best] for index in own if index != best}
    return better


def _once(some: Sequence[Spot], placed: Sequence[Spot]) -> list[Spot]:
    """Leave out a spot that was moved to a street on which its lot stands already."""
    listed = {(one.lot, folded(one.street)) for one in some}
    kept: dict[tuple[str, str], Spot] = {}
    for old, new in zip(some, placed, strict=True):
        name = (new.lot, folded(new.street))
        moved = folded(old.street) != folded(new.street)
        if (moved and name in listed) or name in kept:
            continue
        kept[name] = new
    return list(kept.values())
