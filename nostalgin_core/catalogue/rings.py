"""Lots become fronts, in order round each ring of their block.

Nothing but the catalogue is needed: lot numbers run round a block (anticlockwise in New
York), and house numbers run along a street, odd on one side, even on the other. So

- a street with odd and even numbers in one block cuts it: each parity is on a ring of
  its own, and lots between two of the same parity belong to the same ring;
- in a ring, each street is a side (`sides`); the lots tell the order of the sides;
- along a side, house numbers rise or fall. Each street has one law: if odd numbers rise
  anticlockwise, even ones fall. Lots vote on it, in all blocks together; so do opposite
  sides of a ring, for parallel streets are numbered the same way (`directions`).

A lot above 100 is a later split of the lot with its last two digits: 104 stands by 4.
"""

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from nostalgin_core.catalogue.directions import directions
from nostalgin_core.catalogue.entry import Entry
from nostalgin_core.catalogue.lengths import assumed_width
from nostalgin_core.catalogue.sides import (
    disorder,
    in_order,
    side_facts,
    sides_of,
    with_empty_sides,
)
from nostalgin_core.catalogue.spots import Spot, folded, spots
from nostalgin_core.records import Front


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
