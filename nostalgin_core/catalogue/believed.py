"""On which street a lot is believed to stand, whatever one row says.

Three witnesses speak: the street that is listed, the house number, which has its gap on
some streets of the block and not on others, and the lots before and after. A street is
set aside where the other two are against it: the number has no gap there, and has one
on the neighbours' street; or the lot stands between two of another street. Where a
number fits no street, and the lot stands where a side must be between two parallel
streets, it stands on a side of its own.
"""

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import replace

from nostalgin_core.catalogue.faces import Faces, faces
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
    placed, doubts = [], []
    for index, spot in enumerate(some):
        before, after = _neighbours(some, anchors, index)
        street, why = _street(index, spot, (before, after), known, streets)
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
    known: Faces,
    streets: set[str],
) -> tuple[str, str]:
    """Choose a spot's street, and say why if it is not the listed one."""
    p, q = (one.street for one in beside)
    near = list(dict.fromkeys([p, q]))
    own = folded(spot.street)
    if not own:
        return _without_street(index, spot, near, known)
    inside = own in map(folded, near)
    if (inside and len(near) == 1) or len(streets) == 1:
        return spot.street, ""
    if spot.numbers is None:
        if len(near) == 1 and not spot.split:
            return p, f"the lots before and after it stand on {p}"
        return spot.street, ""
    if known.fits(spot.street, spot.numbers, index):
        return spot.street, ""
    others = [one for one in near if folded(one) != own]
    gaps = [one for one in others if known.fits(one, spot.numbers, index)]
    if gaps:
        return gaps[0], f"its number has its gap on {gaps[0]}"
    if len(near) == 1 and not spot.split:
        return p, f"the lots before and after it stand on {p}"
    parallel = len(near) == 2 and family(p) == family(q) != ""
    if parallel and (inside or _elsewhere(own, known, index)) and not spot.split:
        return UNKNOWN, f"its number fits no street between {p} and {q}"
    if not inside and (spot.split or _elsewhere(own, known, index)):
        return p, "its number fits no street of its block"
    return spot.street, ""


def _without_street(
    index: int, spot: Spot, near: Sequence[str], known: Faces
) -> tuple[str, str]:
    """Place a lot that names no street: where its number fits, or by its neighbours."""
    gaps = [one for one in near if spot.numbers and known.fits(one, spot.numbers, index)]
    street = (gaps or near)[0]
    why = "where its number has its gap" if gaps else "by the lot before it"
    return street, f"it names no street, and is placed on {street} {why}"


def _elsewhere(street: str, known: Faces, index: int) -> bool:
    """Tell whether another lot of the block has a number on a street."""
    return any(
        place != index
        for (one, _), face in known.by_face.items()
        if one == street
        for *_, place in face[:2]
    )


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
