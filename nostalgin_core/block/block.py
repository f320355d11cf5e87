"""The buildings of one tax block, its rings laid out on one ground plane.

A ring is placed on its own (`chain`); the rings of a block face each other over the
street that cuts it, and blocks face each other over the street between them. So one
rule lays out both: two sides on the same street are turned to face, its width apart.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import median

import numpy as np
from jaxtyping import Float

from nostalgin_core.address import house_numbers, plain_name, street_width
from nostalgin_core.arrays import Points
from nostalgin_core.block import heights
from nostalgin_core.block.chain import Footprint, Ring, chain
from nostalgin_core.block.cuboid import ASSUMED_M, counts, cuboid, listed, told
from nostalgin_core.block.heights import Shown
from nostalgin_core.block.outline import nominal_headings
from nostalgin_core.block.widths import Aspects, elevations, with_seen_widths
from nostalgin_core.records import Assignment, Block, Building, Front

FALLBACK_GAP_M = 24.0
NEIGHBOURS = 4
SLIPS = 0.34  # of a side's house numbers: beyond, both parities stand on it


@dataclass(frozen=True, slots=True, eq=False)
class Side:
    """One side of an outline, as a placed line along a street."""

    street: str  # its plain name, as all are here
    start_m: Float[np.ndarray, " 2"]
    end_m: Float[np.ndarray, " 2"]


def block(
    name: str,
    fronts: Sequence[Front],
    assignments: Sequence[Assignment],
    aspects: Aspects,
    *,
    copied: bool = False,
    heights_m: Mapping[str, float] | None = None,
    widths_m: Mapping[str, float] | None = None,
) -> Block:
    """Build the cuboids of one block, ring by ring, in the order of its fronts.

    `widths_m` are of streets, by plain name: one that cuts the block is so wide.

    Raises:
        ValueError: if there are no fronts.
    """
    if not fronts:
        raise ValueError(f"block {name!r} has no fronts")
    shown = elevations(assignments, aspects)
    guessed = {front.front_id for front in fronts if front.width_assumed}
    fronts = with_seen_widths(fronts, shown)
    rings = [
        [front for front in fronts if front.ring == ring]
        for ring in sorted({front.ring for front in fronts})
    ]
    placed = laid_out(list(zip(chained(rings), rings, strict=True)), widths_m or {})
    footprints = _distinct([one for ring in placed for one in ring.footprints])
    buildings = raised(
        footprints, shown, guessed, heights_m or {}, fronts, copied=copied
    )
    return Block(
        block=name,
        buildings=tuple(buildings),
        outline_m=tuple(ring.outline_m for ring in placed),
        closure_m=tuple(ring.closure_m for ring in placed),
    )


def _distinct(footprints: Sequence[Footprint]) -> list[Footprint]:
    """Rename buildings of a lot that stands in several rings, but for the first."""
    used: set[str] = set()
    unique = []
    for footprint in footprints:
        name, count = footprint.building_id, 1
        while name in used:
            count += 1
            name = f"{footprint.building_id}-{count}"
        used.add(name)
        unique.append(replace(footprint, building_id=name))
    return unique


def raised(
    footprints: Sequence[Footprint],
    shown: Mapping[str, Sequence[Shown]],
    guessed: Collection[str],
    heights_m: Mapping[str, float],
    fronts: Sequence[Front] = (),
    *,
    copied: bool,
) -> list[Building]:
    """Raise all buildings; those without a height get their neighbours' median."""
    of = counts(fronts)
    known = [
        heights.height(
            told(one, shown, guessed),
            listed(one, of),
            heights_m.get(one.building_id),
        )
        for one in footprints
    ]
    seen = [(i, one.height_m) for i, one in enumerate(known) if one is not None]
    n = len(known)

    def neighbourly(index: int) -> float:
        near = sorted(seen, key=lambda x: min((x[0] - index) % n, (index - x[0]) % n))
        return float(median(h for _, h in near[:NEIGHBOURS])) if near else ASSUMED_M

    return [
        cuboid(footprint, shown, one, assumed_m=neighbourly(index), copied=copied)
        for index, (footprint, one) in enumerate(zip(footprints, known, strict=True))
    ]


def cutting_streets(rings: Sequence[Sequence[Front]]) -> frozenset[str]:
    """Find the streets on which a block's rings face each other, by plain name.

    Two rings of one block share the streets that go on past both; the one that cuts
    it is the street whose house numbers are odd on one ring and even on the other.
    """
    cutting = set()
    for index, a in enumerate(rings):
        for b in rings[index + 1 :]:
            for street in named(a) & named(b):
                here, there = parities(a, street), parities(b, street)
                if here and there and not here & there:
                    cutting.add(street)
    return frozenset(cutting)


def named(fronts: Sequence[Front]) -> set[str]:
    """Name the streets on which fronts stand, however their list spells each."""
    return {plain_name(front.street) for front in fronts}


def parities(fronts: Sequence[Front], street: str) -> set[int]:
    """Tell whether most house numbers on a street are odd (1) or even (0), or both."""
    numbers = [
        house_numbers(front.address)
        for front in fronts
        if plain_name(front.street) == street
    ]
    odd = [number[0] % 2 for number in numbers if number is not None]
    rarer = min(odd.count(0), odd.count(1))
    if rarer > SLIPS * len(odd):
        return {0, 1}
    return {int(2 * sum(odd) > len(odd))} if odd else set()


def chained(rings: Sequence[Sequence[Front]]) -> list[Ring]:
    """Place each ring on its own, both sides of a cutting street leaning alike.

    Each ring first says by itself how its side on such a street leans; all then take
    the mean, so that the street is straight and the grid beyond it parallel.
    """
    cutting = cutting_streets(rings)
    free = [
        {side: street for side, street in streets_of(ring).items() if street in cutting}
        for ring in rings
    ]
    alone = [
        chain(ring, leaning=dict.fromkeys(sides))
        for ring, sides in zip(rings, free, strict=True)
    ]
    leans: dict[str, list[float]] = {street: [] for street in cutting}
    for ring, sides in zip(alone, free, strict=True):
        nominal = nominal_headings(max(len(ring.headings_rad), 4))
        for side, street in sides.items():
            leans[street].append(ring.headings_rad[side] - float(nominal[side]))
    return [
        chain(
            ring, leaning={side: float(np.mean(leans[s])) for side, s in sides.items()}
        )
        for ring, sides in zip(rings, free, strict=True)
    ]


def laid_out(
    rings: Sequence[tuple[Ring, Sequence[Front]]], widths_m: Mapping[str, float]
) -> list[Ring]:
    """Turn and move rings so that each faces one that lies already, the first as is."""
    placed: list[Ring] = []
    for ring, fronts in rings:
        opposite = _facing(ring, fronts, placed, rings, widths_m)
        placed.append(opposite or _beside(ring, placed))
    return placed


def _facing(
    ring: Ring,
    fronts: Sequence[Front],
    placed: Sequence[Ring],
    rings: Sequence[tuple[Ring, Sequence[Front]]],
    widths_m: Mapping[str, float],
) -> Ring | None:
    for other, (_, theirs) in zip(placed, rings, strict=False):
        cutting = cutting_streets([fronts, theirs])
        mine = [side for side in sides(ring, fronts) if side.street in cutting]
        yours = [side for side in sides(other, theirs) if side.street in cutting]
        for a in mine:
            for b in yours:
                if a.street == b.street:
                    told = widths_m.get(a.street)
                    return face(ring, a, b, gap_m=told or street_width(a.street))
    return None


def streets_of(fronts: Sequence[Front]) -> dict[int, str]:
    """Name the street of each side of a ring."""
    return {front.side: plain_name(front.street) for front in fronts}


def sides(ring: Ring, fronts: Sequence[Front]) -> list[Side]:
    """Name the sides of a ring's outline by the streets of its fronts."""
    ends = np.roll(ring.outline_m, -1, axis=0) if ring.closed else ring.outline_m[1:]
    streets = streets_of(fronts)
    return [
        Side(streets[index], start, end)
        for index, (start, end) in enumerate(zip(ring.outline_m, ends, strict=False))
        if index in streets
    ]


def face(ring: Ring, side: Side, opposite: Side, *, gap_m: float) -> Ring:
    """Turn and move a ring so that a side faces another over a gap, middles aligned."""
    mine, yours = side.end_m - side.start_m, opposite.end_m - opposite.start_m
    turn = np.arctan2(*yours[::-1]) + np.pi - np.arctan2(*mine[::-1])
    outward = np.array([yours[1], -yours[0]]) / np.hypot(*yours)
    target = (opposite.start_m + opposite.end_m) / 2 + gap_m * outward
    return moved(ring, float(turn), target, pivot_m=(side.start_m + side.end_m) / 2)


def moved(
    ring: Ring,
    turn_rad: float,
    target_m: Float[np.ndarray, " 2"],
    *,
    pivot_m: Float[np.ndarray, " 2"],
) -> Ring:
    """Turn a ring about a pivot, then bring the pivot to a target."""
    cos, sin = np.cos(turn_rad), np.sin(turn_rad)

    def carry(points: Points) -> Points:
        return (points - pivot_m) @ np.array([[cos, sin], [-sin, cos]]) + target_m

    return replace(
        ring,
        outline_m=carry(ring.outline_m),
        headings_rad=tuple(heading + turn_rad for heading in ring.headings_rad),
        footprints=tuple(
            replace(footprint, corners_m=carry(footprint.corners_m))
            for footprint in ring.footprints
        ),
    )


def _beside(ring: Ring, placed: Sequence[Ring]) -> Ring:
    """Put a ring that faces no other to the east of all."""
    if not placed:
        return ring
    right = max(_east(one).max() for one in placed)
    shift = np.array([right + FALLBACK_GAP_M - _east(ring).min(), 0.0])
    return moved(ring, 0.0, shift, pivot_m=np.zeros(2))


def _east(ring: Ring) -> Float[np.ndarray, " n"]:
    return np.concatenate([footprint.corners_m[:, 0] for footprint in ring.footprints])
