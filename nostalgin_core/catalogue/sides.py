"""The sides of a ring: its lots by street, in the order in which one walks round it.

The lots tell the order of the sides. A cutting street ends on the same two streets in
both its rings: where a ring lists no lot on one of them, that side is there, but empty;
so is the side that must be between two parallel streets. How lots stand along a side is
told in `along`.
"""

import itertools
from collections import defaultdict
from collections.abc import Mapping, Sequence

from nostalgin_core.catalogue.believed import UNKNOWN
from nostalgin_core.catalogue.spots import Spot, family, folded

Side = list[Spot]


def sides_of(ring: Sequence[Spot]) -> list[Side]:
    """Gather a ring's lots by street, in the order in which the lots reach them.

    A street is reached in the middle of its longest unbroken stretch, counted round
    the ring, so that a lot astray moves none. Lots that were split from others do not
    count, where there are others.
    """
    groups: dict[str, list[int]] = defaultdict(list)
    for place, spot in enumerate(ring):
        groups[folded(spot.street)].append(place)
    middles = {}
    for street, places in groups.items():
        own = [place for place in places if not ring[place].split] or places
        stretch = _longest_stretch(own, ring)
        middles[street] = stretch % len(ring)
    return [
        [ring[place] for place in groups[s]]
        for s in sorted(groups, key=lambda s: (middles[s], s))
    ]


def _longest_stretch(places: Sequence[int], ring: Sequence[Spot]) -> float:
    """Find the middle of the longest stretch of places that no other street breaks."""
    count = len(ring)
    street = folded(ring[places[0]].street)
    stretches = [[places[0]]]
    for a, b in itertools.pairwise(places):
        between = ring[a + 1 : b]
        if any(folded(s.street) != street and not s.split for s in between):
            stretches.append([])
        stretches[-1].append(b)
    wraps = len(stretches) > 1 and all(
        folded(s.street) == street or s.split
        for s in [*ring[places[-1] + 1 :], *ring[: places[0]]]
    )
    if wraps:
        first = stretches.pop(0)
        stretches[-1] += [place + count for place in first]
    # where the lots begin they often run against the rest: of two, the later
    longest = max(reversed(stretches), key=len)
    return (longest[0] + longest[-1]) / 2


def with_empty_sides(rings: Sequence[list[Side]]) -> list[list[Side]]:
    """Add the sides that a ring must have though no lot of it is listed there."""
    whole = [list(ring) for ring in rings]
    for ring in whole:
        _between_parallels(ring)
    for ring in whole:
        for other in [list(one) for one in whole if one is not ring]:
            if len(other) < 3 or len(ring) >= 4:
                continue
            for side in list(ring):
                _complete(ring, side, other)
    return whole


def _between_parallels(ring: list[Side]) -> None:
    """Put an empty side between two parallel streets that would meet."""
    if len(ring) != 3 or not all(ring):
        return
    for place, side in enumerate(ring):
        after = ring[(place + 1) % 3]
        here, there = side[0].street, after[0].street
        if here != there and family(here) and family(here) == family(there):
            ring.insert(place + 1, [])
            return


def _complete(ring: list[Side], side: Side, other: Sequence[Side]) -> None:
    """Put an empty side beside a cutting street, where the other ring has a street."""
    if not side or not _cut_between(side, other):
        return
    streets = [folded(one[0].street) if one else "" for one in other]
    here = streets.index(folded(side[0].street))
    before, after = streets[(here + 1) % len(other)], streets[here - 1]
    own = {folded(one[0].street) for one in ring if one}
    place = ring.index(side)
    if folded(UNKNOWN) in own:
        return
    if after not in own and len(ring) < 4:
        ring.insert(place + 1, [])
    if before not in own and len(ring) < 4:
        ring.insert(place, [])


def _cut_between(side: Sequence[Spot], other: Sequence[Side]) -> bool:
    return any(
        one
        and folded(one[0].street) == folded(side[0].street)
        and {usual(one), usual(side)} == {0, 1}
        for one in other
    )


def usual(side: Sequence[Spot]) -> int | None:
    """Tell the parity that most house numbers of a side have."""
    parities = [spot.parity for spot in side if spot.parity is not None]
    if not parities:
        return None
    return int(2 * sum(parities) >= len(parities))


def unwrapped(side: Sequence[Spot], places: Mapping[tuple[float, str], int]) -> Side:
    """Begin a side after its widest stretch of other lots, round the ring.

    `places` counts the lots of the ring. So a side that has the first lots and the last
    comes out in one piece.
    """
    own = [places[spot.key, spot.lot] for spot in side]
    gaps = [b - a for a, b in zip(own, [*own[1:], own[0] + len(places)], strict=True)]
    last = max(range(len(own)), key=lambda i: (gaps[i], i))
    return [*side[last + 1 :], *side[: last + 1]]
