"""On which street a lot is believed to stand, whatever one row says.

Three witnesses speak: the street that is listed, the house number, which is near to the
numbers of some streets and not of others, and the lots before and after. A street is set
aside where the other two are against it: the number has its gap on the neighbours'
street, and is not near to any on its own. One witness may be a slip itself, so that it
takes two lots of a street to draw another there, or two of its own to drive it away.
Where a number fits no street, and the lot stands where a side must be between two
parallel streets, it stands on a side of its own.
"""

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace

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
    streets = {folded(some[index].street) for index in anchors}
    twins = _twins(some, known)
    placed, doubts = [], []
    for index, spot in enumerate(some):
        beside = _neighbours(some, anchors, index)
        split = [one.street for one in some[max(index - 1, 0) : index + 2] if one.split]
        street, why = _street(
            index, spot, beside, split, known, streets, twins.get(index)
        )
        if folded(street) != folded(spot.street) or why:
            doubts.append((spot, why))
        numbers = spot.numbers
        if spot.street and numbers and folded(street) != folded(spot.street):
            numbers = numbers if known.fits(street, numbers, index) else None
        placed.append(replace(spot, street=street, numbers=numbers))
    return _once(some, placed), doubts


def _neighbours(
    some: Sequence[Spot], anchors: Sequence[int], index: int
) -> tuple[Spot, Spot]:
    """Find the lots before and after that have a street, round the block."""
    place = bisect_left(anchors, index)
    own = place < len(anchors) and anchors[place] == index
    before = some[anchors[place - 1]]
    after = some[anchors[(place + own) % len(anchors)]]
    return before, after


def _street(
    index: int,
    spot: Spot,
    beside: tuple[Spot, Spot],
    split: Sequence[str],
    known: Faces,
    streets: set[str],
    twin: Spot | None,
) -> tuple[str, str]:
    """Choose a spot's street, and say why if it is not the listed one."""
    p, q = (one.street for one in beside)
    near = list(dict.fromkeys([p, q]))
    own = folded(spot.street)
    if not own:
        return _without_street(index, spot, near, known)
    if twin is not None:
        return twin.street, f"row {twin.row} has that number on {twin.street}"
    amid = len(near) == 1 and not spot.split
    if (amid and own == folded(p)) or len(streets) == 1:
        return spot.street, ""
    if spot.numbers is None:
        return (p, _beside(p)) if amid else (spot.street, "")
    if known.near(spot.street, spot.numbers, index):
        return spot.street, ""
    against = known.against(spot.street, spot.numbers, index)
    gap = _gap(index, spot, [*near, *split], known, least=WITNESSES - against)
    if gap:
        return gap, f"its number has its gap on {gap}"
    if against < WITNESSES:
        return spot.street, ""
    if amid:
        return p, _beside(p)
    if len(near) == 2 and family(p) == family(q) != "" and not spot.split:
        return UNKNOWN, f"its number fits no street between {p} and {q}"
    if own not in map(folded, near):
        return p, "its number fits no street of its block"
    return spot.street, ""


def _beside(street: str) -> str:
    return f"the lots before and after it stand on {street}"


def _gap(
    index: int, spot: Spot, near: Sequence[str], known: Faces, *, least: int
) -> str:
    """Find another street where a number has its gap, the neighbours' streets first.

    Farther away it takes two witnesses, and a number that is not just across its own.
    """
    numbers = spot.numbers or (0.0, 0.0)
    across = any(known.near(spot.street, one, index) for one in flipped(numbers))
    for street in [*near, *(() if across else known.named.values())]:
        witnesses = max(least, 1) if street in near else WITNESSES
        if (
            folded(street) != folded(spot.street)
            and known.fits(street, numbers, index)
            and known.near(street, numbers, index) >= witnesses
        ):
            return street
    return ""


def _without_street(
    index: int, spot: Spot, near: Sequence[str], known: Faces
) -> tuple[str, str]:
    """Place a lot that names no street: where its number fits, or by its neighbours."""
    gaps = [one for one in near if spot.numbers and known.fits(one, spot.numbers, index)]
    street = (gaps or near)[0]
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
