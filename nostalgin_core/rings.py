"""Lots become fronts, in order round each ring of their block.

Nothing but the catalogue is needed: lot numbers run round a block (anticlockwise in New
York), and house numbers run along a street, odd on one side, even on the other. So

- a street with odd and even numbers in one block cuts it: each parity is on a ring of
  its own, and lots between two of the same parity belong to the same ring;
- in a ring, each street is a side; the lots tell the order of the sides;
- a cutting street ends on the same two streets in both its rings: where a ring lists
  no lot on one of them, that side is there, but empty;
- along a side, house numbers rise or fall. Each street has one law: if odd numbers rise
  anticlockwise, even ones fall. Lots vote on it, in all blocks together; so do opposite
  sides of a ring, for parallel streets are numbered the same way (`directions`);
- within a side the house number orders; lots without one go by their lot.

A lot above 100 is a later split of the lot with its last two digits: 104 stands by 4.
"""

import itertools
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from nostalgin_core.catalogue import Entry, assumed_width
from nostalgin_core.directions import Law, directions
from nostalgin_core.records import Front
from nostalgin_core.spots import Spot, folded, spots


def fronts(entries: Sequence[Entry]) -> tuple[tuple[Front, ...], tuple[str, ...]]:
    """Order all lots of a catalogue; return its fronts, block by block, and warnings.

    Where every row of a block gives its `side`, those are taken as they are.
    """
    blocks: dict[str, list[Entry]] = defaultdict(list)
    for entry in entries:
        blocks[entry.block].append(entry)
    warnings: list[str] = []
    given: dict[str, list[Front]] = {}
    inferred: dict[str, list[list[list[Spot]]]] = {}
    for block, rows in blocks.items():
        some = spots(rows)
        if all(spot.side is not None for spot in some):
            given[block] = as_given(some)
            continue
        if any(spot.side is not None for spot in some):
            warnings.append(f"block {block}: only some rows give a side; none is used")
        inferred[block] = [sides_of(ring) for ring in split(some)]
        inferred[block] = with_empty_sides(inferred[block])
    law, doubts = directions(
        [side_facts(ring) for rings in inferred.values() for ring in rings]
    )
    made: list[Front] = []
    for block in blocks:
        if block in given:
            made += given[block]
            continue
        for number, ring in enumerate(inferred[block]):
            ordered = [in_order(side, law) for side in ring]
            first = min(spot.key for side in ring for spot in side)
            warnings += [doubt for side in ordered for doubt in disorder(side, first)]
            made += numbered(started(ordered), ring=number)
    return distinct(made), (*warnings, *doubts)


def as_given(some: Sequence[Spot]) -> list[Front]:
    """Take sides and orders from the catalogue."""
    ordered = sorted(
        some, key=lambda one: (one.ring or 0, one.side or 0, one.key, one.number or 0)
    )
    ranks: Counter[int] = Counter()
    made = []
    for spot in ordered:
        ring = spot.ring or 0
        made.append(_front(spot, ring=ring, side=spot.side or 0, rank=ranks[ring]))
        ranks[ring] += 1
    return made


def split(some: Sequence[Spot]) -> list[list[Spot]]:
    """Split a block's lots, in order of lot, into its rings."""
    some = _with_parities(some)
    rings = [list(some)]
    for street in cuts(some):
        halves = []
        for ring in rings:
            parts = [_nearest_parity(ring, street, spot) for spot in ring]
            halves += [
                [one for one, p in zip(ring, parts, strict=True) if p == parity]
                for parity in dict.fromkeys(parts)
            ]
        rings = halves
    return sorted(rings, key=lambda ring: ring[0].key)


def _with_parities(some: Sequence[Spot]) -> list[Spot]:
    """Give a lot without a number the parity of the lot before it on its street."""
    last: dict[str, int | None] = {}
    for spot in reversed(some):  # so that a first lot takes that of the one after it
        last[folded(spot.street)] = (
            spot.parity if spot.parity is not None else last.get(folded(spot.street))
        )
    given = []
    for spot in some:
        street = folded(spot.street)
        parity = last.get(street) if spot.parity is None else spot.parity
        last[street] = parity
        given.append(replace(spot, parity=parity))
    return given


def cuts(some: Sequence[Spot]) -> list[str]:
    """List the streets that cut a block: numbers turn odd once and even once, by lot.

    Where they change more often, both kinds stand on one side (as on a street with a
    park across it) or one is a slip; either way nothing is cut.
    """
    runs: dict[str, list[int]] = defaultdict(list)
    for spot in some:
        if spot.parity is not None:
            runs[folded(spot.street)].append(spot.parity)
    return [
        street
        for street, parities in runs.items()
        if sum(a != b for a, b in zip(parities, np.roll(parities, 1), strict=True)) == 2
        and min(Counter(parities).values()) > 1
    ]


def _nearest_parity(ring: Sequence[Spot], street: str, spot: Spot) -> int | None:
    """Tell on which side of a cutting street a lot lies, by its neighbours along it."""
    if folded(spot.street) == street:
        return spot.parity
    along = [one for one in ring if folded(one.street) == street]
    if not along:
        return None
    turn = max(one.key for one in ring) - min(one.key for one in ring) + 1.0

    def after(one: Spot) -> float:
        return (one.key - spot.key) % turn

    following, leading = min(along, key=after), max(along, key=after)
    nearer = min(following, leading, key=lambda one: min(after(one), turn - after(one)))
    return following.parity if following.parity == leading.parity else nearer.parity


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
    """Count pairs in the same order, less pairs in the opposite one."""
    x, y = np.asarray(a, float), np.asarray(b, float)
    signs = np.sign(x[:, None] - x) * np.sign(y[:, None] - y)
    return float(signs.sum() / 2)


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


def distinct(made: Sequence[Front]) -> tuple[Front, ...]:
    """Count fronts of one name: a lot may have several on sides of the same number.

    They stand in different rings, or on two streets that make one side.
    """
    used: set[str] = set()
    unique = []
    for front in made:
        name, count = front.front_id, 1
        while name in used:
            count += 1
            name = f"{front.front_id}-{count}"
        used.add(name)
        unique.append(replace(front, front_id=name))
    return tuple(unique)


def started(sides: Sequence[list[Spot]]) -> list[list[Spot]]:
    """Begin a ring with its first side street, and never end it with an empty side."""
    starts = [index for index in range(len(sides)) if sides[index - 1] and sides[index]]
    named = [
        i for i in starts if folded(sides[i][0].street).endswith(("street", " st"))
    ]
    first = (named or starts or [0])[0]
    return [*sides[first:], *sides[:first]]


def numbered(sides: Sequence[Sequence[Spot]], *, ring: int) -> list[Front]:
    """Number the sides and the fronts along them."""
    made = []
    for side, some in enumerate(sides):
        for spot in some:
            made.append(_front(spot, ring=ring, side=side, rank=len(made)))
    return made


def _front(spot: Spot, *, ring: int, side: int, rank: int) -> Front:
    return Front(
        front_id=f"{spot.block}-{spot.lot}-{side}",
        block=spot.block,
        lot=spot.lot,
        ring=ring,
        side=side,
        rank=rank,
        street=spot.street,
        address=spot.address,
        width_m=assumed_width(spot.address) if spot.width_m is None else spot.width_m,
        depth_m=spot.depth_m,
        width_assumed=spot.width_m is None,
    )
