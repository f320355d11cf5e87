"""House numbers that two lots claim, and which of the two is set aside.

Of lots that claim the same numbers the one that crowds most others is wrong; of two
that crowd each other alone, the one whose number has its gap across the street, or on
the street of the lots beside it, while the other's has none.
"""

from collections.abc import Sequence
from dataclasses import replace

from nostalgin_core.catalogue.faces import Faces, faces, flipped
from nostalgin_core.catalogue.spots import Spot, folded

Doubts = list[tuple[Spot, str]]


def uncrowded(some: Sequence[Spot]) -> tuple[list[Spot], Doubts]:
    """Set aside the numbers that another lot has with better right."""
    known = faces(some)
    claims = {
        index: [other for other in taken if some[other].lot != one.lot]
        for index, one in enumerate(some)
        if one.numbers and (taken := known.taken(one.street, one.numbers, index))
    }
    kept, doubts = list(some), []
    for index, others in claims.items():
        if not others:
            continue
        with_whom = ", ".join(some[other].told() for other in others[:3])
        doubts.append((some[index], f"its number is also that of {with_whom}"))
        rivals = [len(claims.get(other, ())) for other in others]
        most = len(others) > max(rivals)
        same = len(others) == max(rivals) == 1
        if most or (
            same
            and _movable(some, index, known)
            and not _movable(some, others[0], known)
        ):
            kept[index] = replace(some[index], numbers=None)
    return kept, doubts


def _movable(some: Sequence[Spot], index: int, known: Faces) -> bool:
    """Tell whether a number has its gap across the street or round the corner."""
    spot = some[index]
    if spot.numbers is None:
        return False
    beside = (some[index - 1], some[(index + 1) % len(some)])
    round_it = [
        one.street for one in beside if folded(one.street) != folded(spot.street)
    ]
    across = any(
        known.fits(spot.street, numbers, index) for numbers in flipped(spot.numbers)
    )
    return across or any(known.fits(s, spot.numbers, index) for s in round_it)
