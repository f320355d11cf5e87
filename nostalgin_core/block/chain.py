"""Fronts become footprints: the paper's algorithm 2, mended, round any ring.

The paper (appendix, algorithm 2) walks from a front to its neighbour with a point
(x, y) and a cardinal direction, and puts a cube at each step. As printed

1. the pointer never moves, so the loop never ends: here each side is walked front by
   front, and each ring side by side;
2. it turns *before* it places a corner building, which so lands one side too far along
   the new direction: here the building is placed first, then the walk turns at its far
   edge;
3. a corner building is met on both its sides and built twice: here it is built once,
   from both its widths (one is its width, the other its depth);
4. it turns only at a building with two known fronts, so that a ring without one never
   closes: here every change of side is a corner, and where no lot has a front on both
   streets, one of the two that meet there is given the corner;
5. it turns by 90 degrees and does not check that the walk comes home: here the ring is
   closed first (`outline`), opposite sides reconciled, with any number of sides.

Party walls run along the neighbouring side at either end of a side, and turn gradually
between; in a rectangular ring they are all square to the street, and every footprint is
a rectangle. A ring of one side is a straight row, a ring of two sides an open corner.
"""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Corners, Points
from nostalgin_core.block import outline
from nostalgin_core.block.apart import apart
from nostalgin_core.block.depth import measured
from nostalgin_core.block.pieces import (
    DOUBT,
    Piece,
    fitted,
    pieces,
    with_corners,
)
from nostalgin_core.records import Front

NOTHING_M = 0.01  # of an opening

Vector = Float[np.ndarray, " 2"]


@dataclass(frozen=True, slots=True, eq=False)
class Footprint:
    """Where one building stands."""

    building_id: str
    corners_m: Corners  # anticlockwise from the left end of its first front
    front_ids: tuple[str | None, ...]  # one per edge
    turns: int = 0  # corners of the ring that it stands round


@dataclass(frozen=True, slots=True, eq=False)
class Ring:
    """A ring of fronts on the ground, its first side heading east from the origin."""

    footprints: tuple[Footprint, ...]  # in order round the ring
    outline_m: Points  # the corners, anticlockwise
    headings_rad: tuple[float, ...]  # of each side, from east, anticlockwise
    closed: bool
    closure_m: float = 0.0  # by how much the sides as measured miss their start


def chain(
    fronts: Sequence[Front], *, leaning: Mapping[int, float | None] | None = None
) -> Ring:
    """Place the fronts of one ring.

    Sides of four-sided rings meet at right angles, but for those that are `leaning` (on
    a street that cuts the grid, as Broadway): by so many radians from the right angle,
    or, where that is None, by what the other sides' lengths say. Rings of three sides,
    or five and more, are free throughout.

    Raises:
        ValueError: if there are no fronts.
    """
    if not fronts:
        raise ValueError("a ring needs at least one front")
    sides = with_corners(pieces(fronts))
    closed = len(sides) > 2
    closure_m = 0.0
    if closed:
        known = measured(sides, leaning or {})
        closure_m = outline.closure(known)
        lengths_m, headings = outline.close(known)
    else:
        lengths_m = np.array([sum(p.width_m for p in side) for side in sides])
        headings = outline.nominal_headings(4)[: len(sides)]
    starts_m = outline.corners(lengths_m, headings)
    spans = [
        fitted(side, length) for side, length in zip(sides, lengths_m, strict=True)
    ]
    _shorten(sides, spans, starts_m, headings, closed=closed)
    name = f"{fronts[0].block}-gap-{fronts[0].ring}"
    footprints = _walked(sides, spans, starts_m, headings, closed=closed)
    gaps = _gaps(sides, spans, starts_m, headings, closed=closed, name=name)
    footprints = [
        each for one in footprints for each in (one, *gaps.get(one.building_id, ()))
    ]
    end_m = starts_m[-1] + lengths_m[-1] * _ahead(headings[-1])
    return Ring(
        footprints=tuple(_apart(footprints, starts_m if closed else None)),
        outline_m=starts_m if closed else np.vstack([starts_m, end_m]),
        headings_rad=tuple(float(heading) for heading in headings),
        closed=closed,
        closure_m=closure_m,
    )


def _ahead(heading: float) -> Vector:
    return np.array([np.cos(heading), np.sin(heading)])


def _walked(
    sides: Sequence[Sequence[Piece]],
    spans: Sequence[Sequence[tuple[float, float]]],
    starts_m: Points,
    headings: Float[np.ndarray, " n"],
    *,
    closed: bool,
) -> list[Footprint]:
    """Walk round the ring once and place each building where its first front starts."""
    placed: list[Footprint] = []
    for run in _runs(sides, closed=closed):
        (here, index), (end, last) = run[0], run[-1]
        piece = sides[here][index]
        points = [
            starts_m[here] + spans[here][index][0] * _ahead(headings[here]),
            *(starts_m[side] for side, _ in run[1:]),
            starts_m[end] + spans[end][last][1] * _ahead(headings[end]),
        ]
        if len(run) == 1:
            back = piece.depth_m * _party_walls(
                headings, here, spans[here], spans[here][index], closed=closed
            )
            points += [points[1] + back[1], points[0] + back[0]]
        elif len(run) == 2:
            points.append(points[0] + points[2] - points[1])
        fronts = tuple(sides[s][i].front_id for s, i in run)
        placed.append(_footprint(piece.building_id, points, fronts))
    if not placed:  # one building is the whole block
        fronts = tuple(side[0].front_id for side in sides)
        points = [*starts_m, (starts_m[-1] + starts_m[0]) / 2]
        placed.append(_footprint(sides[0][0].building_id, points, fronts))
    return placed


def _gaps(
    sides: Sequence[Sequence[Piece]],
    spans: Sequence[Sequence[tuple[float, float]]],
    starts_m: Points,
    headings: Float[np.ndarray, " n"],
    *,
    closed: bool,
    name: str,
) -> dict[str, list[Footprint]]:
    """Close the openings where lots are missing, each by a building without a front.

    It is as deep as the shallower of the two beside it, called by its side (a second
    one there by its number, too), and listed under the building that it comes after.
    """
    made: dict[str, list[Footprint]] = defaultdict(list)
    for here, side in enumerate(sides):
        count = 0
        for index in range(1, len(side)):
            gap = (spans[here][index - 1][1], spans[here][index][0])
            if gap[1] - gap[0] < NOTHING_M:
                continue
            back = _party_walls(headings, here, spans[here], gap, closed=closed)
            back = back * min(side[index - 1].depth_m, side[index].depth_m)
            ends = starts_m[here] + np.outer(gap, _ahead(headings[here]))
            points = [*ends, ends[1] + back[1], ends[0] + back[0]]
            count += 1
            called = f"{name}-{here}" + (f"-{count}" if count > 1 else "")
            closing = _footprint(called, points, (None,))
            made[side[index - 1].building_id].append(closing)
    return made


def _shorten(
    sides: Sequence[Sequence[Piece]],
    spans: Sequence[list[tuple[float, float]]],
    starts_m: Points,
    headings: Float[np.ndarray, " n"],
    *,
    closed: bool,
) -> None:
    """End what turns two corners and is unseen on its last side as deep as it began.

    So its inner wall runs along the street between, and clears its neighbours. Little
    that it leaves of the last side is the next one's; more is an opening like others.
    """
    for run in _runs(sides, closed=closed):
        (here, index), (end, last) = run[0], run[-1]
        if len(run) != 3 or sides[end][last].front_id is not None:
            continue
        ahead = _ahead(headings[run[1][0]])
        inward = np.array([-ahead[1], ahead[0]])
        began_m = starts_m[here] + spans[here][index][0] * _ahead(headings[here])
        from_m, to_m = spans[end][last]
        deep = float((began_m - starts_m[run[1][0]]) @ inward)
        reach = float(_ahead(headings[end]) @ inward) * to_m
        left_m = to_m * (1.0 - min(1.0, deep / max(reach, 1e-9)))
        spans[end][last] = from_m, to_m - left_m
        beside = spans[end][last + 1 : last + 2]
        small = left_m < DOUBT * spans[end][-1][1]
        if beside and small and beside[0][0] - to_m < NOTHING_M:
            spans[end][last + 1] = to_m - left_m, beside[0][1]


def _runs(
    sides: Sequence[Sequence[Piece]], *, closed: bool
) -> Iterator[list[tuple[int, int]]]:
    """List the pieces of each building, from its first front on.

    A piece that continues a building from round the corner begins none.
    """
    for here, side in enumerate(sides):
        for index, piece in enumerate(side):
            before = sides[here - 1] if closed or here else []
            if index == 0 and before and before[-1].building_id == piece.building_id:
                continue
            yield _run(sides, here, index, closed=closed)


def _run(
    sides: Sequence[Sequence[Piece]], here: int, index: int, *, closed: bool
) -> list[tuple[int, int]]:
    """Follow one building round corners; return its pieces as (side, index)."""
    building = sides[here][index].building_id
    run = [(here, index)]
    while run[-1][1] == len(sides[run[-1][0]]) - 1:
        there = run[-1][0] + 1
        if there == len(sides) and not closed:
            break
        following = sides[there % len(sides)]
        if not following or following[0].building_id != building:
            break
        run.append((there % len(sides), 0))
    return run


def _footprint(
    building_id: str, points: Sequence[Vector], fronts: tuple[str | None, ...]
) -> Footprint:
    """Keep four corners and a front, or None, for each edge."""
    four = (*fronts, None, None, None)[:4]
    return Footprint(building_id, np.array(points[:4]), four, min(len(fronts) - 1, 3))


def _party_walls(
    headings: Float[np.ndarray, " n"],
    here: int,
    spans: Sequence[tuple[float, float]],
    span: tuple[float, float],
    *,
    closed: bool,
) -> Float[np.ndarray, "2 2"]:
    """Find the ways back from the street at both ends of one stretch of a side.

    Each is one metre deep, measured square to the street.
    """
    ahead = _ahead(headings[here])
    inward = np.array([-ahead[1], ahead[0]])
    count = len(headings)
    at_start = at_end = inward
    if closed or here > 0:
        at_start = _one_deep(-_ahead(headings[here - 1]), inward)
    if closed or here + 1 < count:
        at_end = _one_deep(_ahead(headings[(here + 1) % count]), inward)
    between = (spans[0][1], spans[-1][0]) if len(spans) > 2 else (0.0, spans[-1][1])
    length_m = max(between[1] - between[0], 1e-9)
    share = np.clip((np.array(span) - between[0]) / length_m, 0.0, 1.0)[:, None]
    return at_start * (1 - share) + at_end * share


def _one_deep(back: Vector, inward: Vector) -> Vector:
    depth = float(back @ inward)
    # a wall leaning by over 60 degrees would leave a sliver: it goes square instead
    return back / depth if depth > 0.5 else inward


def _apart(
    footprints: Sequence[Footprint], outline_m: Points | None
) -> list[Footprint]:
    corners = apart(
        [footprint.corners_m for footprint in footprints],
        [footprint.turns for footprint in footprints],
        outline_m=outline_m,
    )
    return [
        replace(footprint, corners_m=four)
        for footprint, four in zip(footprints, corners, strict=True)
    ]
