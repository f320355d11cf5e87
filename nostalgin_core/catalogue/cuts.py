"""Streets cut a block into rings: their numbers are odd on one, even on the other.

Lots run round the block, and so they cross a cutting street twice: from its odd lots to
its even ones, and back. Without the cut a street or two would be met twice on one walk.
So two explanations are weighed for each street with odd and even numbers:

- nothing is cut: each street met again counts one, and so does each lot of the rarer
  parity, or two where no number across the street would stand in its place;
- it is cut: that counts `CUT`, and what is left in either ring counts as before.

One slip counts one, so that it neither makes a cut nor undoes one. Lots of other
streets stand on the ring of the cutting street's lots before and after them. Where
these differ, the crossing lies at one end of theirs: they stand where their streets are
not met twice.
"""

from bisect import bisect_right
from collections import Counter, defaultdict
from collections.abc import Sequence
from itertools import pairwise
from typing import Final

from nostalgin_core.catalogue.faces import Faces, faces, flipped
from nostalgin_core.catalogue.spots import Spot, folded

CUT: Final = 1.5  # slips: more than one, less than two
FEW: Final = 4  # lots: that so many slipped alike is not weighed one by one
NEXT: Final = 12.0  # numbers: a split lot stands by one it was split from
CHANGE: Final = 0.75  # of parity, on the walk: a lone lot between two is no change
LONE: Final = 0.4  # or it is one


def split(some: Sequence[Spot]) -> list[list[Spot]]:
    """Split a block's spots, in order of lot, into its rings."""
    rings = _cut(list(some))
    return sorted(rings, key=lambda ring: ring[0].key)


def _cut(some: list[Spot]) -> list[list[Spot]]:
    """Cut by the street that explains most, and each part again."""
    anchors = [one for one in some if not one.split] or some
    known = faces(anchors)
    best: tuple[float, str, list[int]] | None = None
    for street in _both_parities(anchors):
        for change in (CHANGE, LONE):
            labels = _labels(anchors, street, change)
            gain = _uncut(anchors, street, known) - _cost(anchors, street, labels)
            if labels and gain > 0 and (best is None or gain > best[0]):
                best = (gain, street, labels)
    if best is None:
        return [some]
    _, street, labels = best
    parts: tuple[list[Spot], list[Spot]] = ([], [])
    for spot, label in zip(some, _all(some, anchors, street, labels), strict=True):
        parts[label].append(spot)
    return [ring for part in parts for ring in _cut(part)]


def _both_parities(some: Sequence[Spot]) -> list[str]:
    """List the streets with odd and even numbers."""
    found: dict[str, set[int]] = defaultdict(set)
    for spot in some:
        if spot.parity is not None:
            found[folded(spot.street)].add(spot.parity)
    return [street for street, parities in found.items() if len(parities) == 2]


def _uncut(some: Sequence[Spot], street: str, known: Faces) -> int:
    """Count the slips it would take to explain a block without a cut."""
    own = [i for i, one in enumerate(some) if folded(one.street) == street]
    weights = []
    for parity in (0, 1):
        odd_ones = [i for i in own if some[i].parity == parity]
        if len(odd_ones) <= FEW:
            weights.append(sum(1 + (not _slipped(some, i, known)) for i in odd_ones))
        else:
            weights.append(len(odd_ones))
    return _met_again(some) + min(weights)


def _met_again(some: Sequence[Spot]) -> int:
    """Count how often a walk round the lots meets a street it has left."""
    streets = [folded(spot.street) for spot in some]
    runs = [
        a for a, b in zip(streets, [*streets[1:], *streets[:1]], strict=True) if a != b
    ]
    return sum(count - 1 for count in Counter(runs).values())


def _slipped(some: Sequence[Spot], index: int, known: Faces) -> bool:
    """Tell whether a lot would stand well across its street, by the lots beside it."""
    spot = some[index]
    if spot.numbers is None:
        return True
    street = folded(spot.street)
    if not any(known.near(spot.street, one, index) for one in flipped(spot.numbers)):
        return True  # no number of this stretch at all
    before = _beside(some, index, -1, street, 1 - (spot.parity or 0))
    after = _beside(some, index, 1, street, 1 - (spot.parity or 0))
    if before is None or after is None:
        return False
    low, high = sorted((some[before].number or 0.0, some[after].number or 0.0))
    fitting = [
        one for one in flipped(spot.numbers) if known.fits(spot.street, one, index)
    ]
    if any(folded(some[(index + s) % len(some)].street) != street for s in (-1, 1)):
        return bool(fitting)
    first_or_last = index in (0, len(some) - 1)
    return not first_or_last or any(low < a and b < high for a, b in fitting)


def _beside(
    some: Sequence[Spot], index: int, step: int, street: str, parity: int
) -> int | None:
    """Find the next lot of a face, before or after."""
    for far in range(1, len(some)):
        place = (index + step * far) % len(some)
        if folded(some[place].street) == street and some[place].parity == parity:
            return place
    return None


def _labels(some: Sequence[Spot], street: str, change: float) -> list[int]:
    """Tell on which ring each lot stands if the street is cut; empty if none fits."""
    along = [i for i, spot in enumerate(some) if folded(spot.street) == street]
    own = _smoothed([some[i].parity for i in along], change)
    if len(set(own)) < 2 or _impure([some[i].parity for i in along], own):
        return []
    labels = [-1] * len(some)
    for place, label in zip(along, own, strict=True):
        labels[place] = label
    unsettled = []
    for a, b in pairwise([*along, along[0] + len(some)]):
        between = [place % len(some) for place in range(a + 1, b)]
        if labels[a % len(some)] == labels[b % len(some)]:
            for place in between:
                labels[place] = labels[a]
        elif between:
            unsettled.append((a, b, between))
    for a, b, between in unsettled:
        label = _where_new(some, labels, between, (a, b % len(some)), street)
        for place in between:
            labels[place] = label
    return labels


def _where_new(
    some: Sequence[Spot],
    labels: Sequence[int],
    between: Sequence[int],
    ends: tuple[int, int],
    street: str,
) -> int:
    """Choose the ring on which a stretch of lots meets no street again."""
    own = {folded(some[place].street) for place in between} - {street}
    met = [
        {folded(s.street) for s, at in zip(some, labels, strict=True) if at == label}
        for label in (0, 1)
    ]
    again = [len(own & streets) for streets in met]
    if again[0] != again[1]:
        return int(again[1] < again[0])
    along = [
        at for s, at in zip(some, labels, strict=True) if folded(s.street) == street
    ]
    if 1 in (along.count(0), along.count(1)) and len(along) > 2:
        return int(along.count(0) == 1)  # an island has no other street
    turn = some[-1].key - some[0].key + 1.0
    before = (some[between[0]].key - some[ends[0]].key) % turn
    after = (some[ends[1]].key - some[between[-1]].key) % turn
    return labels[ends[0]] if before <= after else labels[ends[1]]


def _smoothed(parities: Sequence[int | None], change: float) -> list[int]:
    """Find the ring of each lot of a cutting street: as few changes as explain most.

    The walk is round, so that it is taken twice and the second half kept.
    """
    twice = [*parities, *parities]
    costs, origins = [0.0, 0.0], []
    for parity in twice:
        # of two ways that cost the same, the parity changes late
        ways = [
            min((costs[1 - at] + change, False, 1 - at), (costs[at], True, at))
            for at in (0, 1)
        ]
        origins.append([came_from for *_, came_from in ways])
        costs = [ways[at][0] + (parity is not None and parity != at) for at in (0, 1)]
    at = int(costs[1] < costs[0])
    found = []
    for origin in reversed(origins):
        found.append(at)
        at = origin[at]
    return found[::-1][len(parities) :]


def _impure(parities: Sequence[int | None], labels: Sequence[int]) -> bool:
    """Tell whether a ring would hold half as many lots of the other parity."""
    for label in (0, 1):
        own = [p for p, at in zip(parities, labels, strict=True) if at == label]
        wrong = sum(p is not None and p != label for p in own)
        if 2 * wrong > sum(p == label for p in own):
            return True
    return False


def _cost(some: Sequence[Spot], street: str, labels: Sequence[int]) -> float:
    """Count a cut, and the slips that are left in its rings."""
    if not labels:
        return float("inf")
    left = 0
    for label in (0, 1):
        own = [s for s, at in zip(some, labels, strict=True) if at == label]
        left += _met_again(own)
        left += sum(
            folded(s.street) == street and s.parity not in (None, label) for s in own
        )
    return CUT + left


def _all(
    some: Sequence[Spot],
    anchors: Sequence[Spot],
    street: str,
    labels: Sequence[int],
) -> list[int]:
    """Give split lots the ring of their street, parity and nearest lots, too."""
    if len(anchors) == len(some):
        return list(labels)
    keys = [one.key for one in anchors]
    known = {id(one): label for one, label in zip(anchors, labels, strict=True)}
    reach: dict[tuple[str, int], list[float]] = defaultdict(list)
    for one, label in zip(anchors, labels, strict=True):
        reach[folded(one.street), label] += one.numbers or ()
    made = []
    for spot in some:
        on = folded(spot.street)
        if id(spot) in known:
            made.append(known[id(spot)])
        elif on == street and spot.parity is not None:
            made.append(spot.parity)
        else:
            near = labels[bisect_right(keys, spot.key) - 1]
            far = [
                min((abs(one - spot.number) for one in reach[on, label]), default=NEXT)
                if spot.number is not None
                else NEXT
                for label in (near, 1 - near)
            ]
            made.append(near if far[0] <= far[1] or far[1] >= NEXT else 1 - near)
    return made


def lone(rings: Sequence[Sequence[Spot]]) -> list[Spot]:
    """List the lots that have a ring to themselves, if there are other rings."""
    return [
        ring[0]
        for ring in rings
        if len(rings) > 1 and len({one.lot for one in ring}) == 1
    ]
