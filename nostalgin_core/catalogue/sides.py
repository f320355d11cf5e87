"""The sides of a ring: its lots by street, in the order in which one walks round it.

The lots tell the order of the sides. Along a side, house numbers rise or fall by the
law of its street (`directions`); lots without one go by their lot. A cutting street
ends on the same two streets in both its rings: where a ring lists no lot on one of
them, that side is there, but empty.
"""

import itertools
from bisect import bisect_left, bisect_right, insort
from collections import defaultdict
from collections.abc import Iterable, Sequence

import numpy as np

from nostalgin_core.catalogue.directions import Law
from nostalgin_core.catalogue.spots import Spot, folded


def sides_of(ring: Sequence[Spot]) -> list[list[Spot]]:
    """Gather a ring's lots by street, in the order in which the lots reach them.

    The order is that of the circular means of the lots' places, so that a street that
    has both the first and the last lots comes out once.
    """
    groups: dict[str, list[int]] = defaultdict(list)
    for place, spot in enumerate(ring):
        groups[folded(spot.street)].append(place)
    angles = {
        street: float(
            np.angle(np.exp(2j * np.pi * np.array(places) / len(ring)).sum())
            % (2 * np.pi - 1e-9)
        )
        for street, places in groups.items()
    }
    return [
        [ring[place] for place in groups[s]]
        for s in sorted(groups, key=angles.__getitem__)
    ]


def with_empty_sides(rings: Sequence[list[list[Spot]]]) -> list[list[list[Spot]]]:
    """Add the sides that a ring must have though no lot of it is listed there."""
    whole = [list(ring) for ring in rings]
    for index, ring in enumerate(whole):
        for other in rings:
            if other is rings[index] or len(other) < 3 or len(ring) >= 4:
                continue
            for side in list(ring):
                _complete(ring, side, other)
    return whole


def _complete(
    ring: list[list[Spot]], side: list[Spot], other: list[list[Spot]]
) -> None:
    """Put an empty side beside a cutting street, where the other ring has a street."""
    if not side or not _cut_between(side, other):
        return
    streets = [folded(one[0].street) if one else "" for one in other]
    here = streets.index(folded(side[0].street))
    before, after = streets[(here + 1) % len(other)], streets[here - 1]
    own = {folded(one[0].street) for one in ring if one}
    place = ring.index(side)
    if after not in own and len(ring) < 4:
        ring.insert(place + 1, [])
    if before not in own and len(ring) < 4:
        ring.insert(place, [])


def _cut_between(side: Sequence[Spot], other: Sequence[Sequence[Spot]]) -> bool:
    return any(
        one
        and folded(one[0].street) == folded(side[0].street)
        and {spot.parity for spot in one}.isdisjoint({spot.parity for spot in side})
        for one in other
    )


def side_facts(ring: Sequence[Sequence[Spot]]) -> list[tuple[str, int, float] | None]:
    """Tell each side's street, parity (1 odd, -1 even), and how lots order its numbers.

    The last is the number of pairs in which lot and house number rise together, less
    those in which one falls.
    """
    lots = sorted({(spot.key, spot.lot) for side in ring for spot in side})
    place = {lot: index for index, lot in enumerate(lots)}
    turn = len(lots)
    facts: list[tuple[str, int, float] | None] = []
    for side in ring:
        known = [one for one in side if one.number is not None]
        if not known:
            facts.append(None)
            continue
        places = np.array([place[one.key, one.lot] for one in side])
        mean = np.angle(np.exp(2j * np.pi * places / turn).sum()) / (2 * np.pi) * turn
        start = float(mean) - turn / 2
        keys = [(place[one.key, one.lot] - start) % turn for one in known]
        numbers = [one.number or 0.0 for one in known]
        parity = 1 if known[0].parity else -1
        facts.append((folded(side[0].street), parity, _agreement(keys, numbers)))
    return facts


def _agreement(a: Sequence[float], b: Sequence[float]) -> float:
    """Count pairs in the same order, less pairs in the opposite one.

    Each is compared with those of lesser `a`, which are kept in order: all pairs in a
    matrix would take 3 GiB for 20,000 lots.
    """
    lesser: list[float] = []
    total = 0
    for _, pairs in itertools.groupby(
        sorted(zip(a, b, strict=True)), lambda one: one[0]
    ):
        new = [y for _, y in pairs]
        for y in new:
            below, above = bisect_left(lesser, y), len(lesser) - bisect_right(lesser, y)
            total += below - above
        for y in new:
            insort(lesser, y)
    return float(total)


def in_order(side: Sequence[Spot], law: Law) -> list[Spot]:
    """Order one side anticlockwise: by house number, by lot where there is none."""
    if not any(spot.number is not None for spot in side):
        return sorted(side, key=lambda spot: spot.key)
    parity = next(1 if one.parity else -1 for one in side if one.number is not None)
    rising = law.get(folded(side[0].street), 1) * parity
    known = [one for one in side if one.number is not None]

    def place(spot: Spot) -> tuple[float, float]:
        if spot.number is not None:
            return (rising * spot.number, 0.0)
        before = [one for one in known if one.key < spot.key]
        if before:
            near = max(before, key=lambda one: one.key)
            return (rising * (near.number or 0.0), 1.0 + spot.key)
        near = min(known, key=lambda one: one.key)
        return (rising * (near.number or 0.0), spot.key - 1e6)

    return sorted(side, key=place)


def disorder(side: Sequence[Spot], first: float) -> Iterable[str]:
    """Name the neighbours whose lots run against the rest of their side.

    Where the ring's last lot meets its `first`, they always do.
    """
    keys = [spot.key for spot in side]
    falling = _agreement(keys, [float(place) for place in range(len(side))]) < 0
    for a, b in itertools.pairwise(side):
        against = (a.key < b.key) if falling else (a.key > b.key)
        known = a.number is not None and b.number is not None
        if against and known and len(side) > 2 and first not in (a.key, b.key):
            yield (
                f"block {a.block}, {a.street}: lots {a.lot} ({a.address}) and {b.lot} "
                f"({b.address}) stand by house number, against the order of lots"
            )
