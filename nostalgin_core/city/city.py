"""Blocks take their places by the streets between them.

The paper calls it a trivial extension: given where each block lies relative to others.
Here that is found from the catalogue. Two blocks with fronts on the same street

- face each other over it, if the house numbers are odd on one and even on the other;
  where they also share a crossing, those corners are put opposite;
- or follow one another along it, if both are odd or both even: by so many metres as
  their house numbers are apart, at the density of numbers on these very sides.

A block that shares no street with any other stands by itself, to the east. So do blocks
that would overlap one that stands already.

Blocks are placed one by one: the first that may face a standing one, else the first
that may follow one. A way that is not clear never will be, for blocks that stand never
go; so each is tried once, and a city of thousands of blocks takes no cube of them.
"""

import heapq
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from jaxtyping import Float

from nostalgin_core.address import STREET_M, house_numbers, street_width
from nostalgin_core.arrays import Points
from nostalgin_core.block import FALLBACK_GAP_M
from nostalgin_core.records import Front

Vector = Float[np.ndarray, " 2"]


@dataclass(frozen=True, slots=True)
class Move:
    """A turn about a block's own origin, then a shift: from its frame to the city's."""

    turn_rad: float = 0.0
    east_m: float = 0.0
    north_m: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Border:
    """One side of a block along a street, and the streets at both its corners."""

    street: str
    before: str
    after: str
    start_m: Vector
    end_m: Vector
    numbers: tuple[int, int] | None  # the first and the last on the way along

    @property
    def parity(self) -> int | None:
        """Tell whether the numbers are odd (1) or even (0)."""
        return None if self.numbers is None else self.numbers[0] % 2


@dataclass(frozen=True, slots=True, eq=False)
class Plot:
    """A block's ground."""

    block: str
    outlines_m: tuple[Points, ...]
    borders: tuple[Border, ...]


def plot(name: str, outlines_m: Sequence[Points], fronts: Sequence[Front]) -> Plot:
    """Name the sides of a block's outlines, one a ring, by its fronts' streets."""
    rings = sorted({front.ring for front in fronts})
    borders = [
        border
        for outline_m, ring in zip(outlines_m, rings, strict=True)
        for border in _borders(outline_m, [one for one in fronts if one.ring == ring])
    ]
    return Plot(name, tuple(outlines_m), tuple(borders))


def places(plots: Sequence[Plot]) -> dict[str, Move]:
    """Find where each block goes; the first stays where it is."""
    sharing = _sharing(plots)
    moves: dict[str, Move] = {}
    standing: dict[int, Plot] = {}
    grounds: list[shapely.Geometry] = []
    tries: list[tuple[int, int, int]] = []  # a heap of rule, block, standing block
    for first in range(len(plots)):
        while first not in standing:
            index, move = _next_clear(plots, standing, grounds, tries) or (
                first,
                _beside(plots[first], grounds),
            )
            moves[plots[index].block] = move
            standing[index] = _moved(plots[index], move)
            grounds.append(_ground(standing[index]))
            for other in sharing[index] - standing.keys():
                for rule in range(len(RULES)):
                    heapq.heappush(tries, (rule, other, index))
    return moves


def _sharing(plots: Sequence[Plot]) -> list[set[int]]:
    """Tell for each block which blocks have a street of it."""
    on: dict[str, set[int]] = defaultdict(set)
    for index, one in enumerate(plots):
        for border in one.borders:
            on[border.street].add(index)
    return [
        set().union(*(on[border.street] for border in one.borders)) for one in plots
    ]


def _next_clear(
    plots: Sequence[Plot],
    standing: dict[int, Plot],
    grounds: Sequence[shapely.Geometry],
    tries: list[tuple[int, int, int]],
) -> tuple[int, Move] | None:
    """Take ways from the heap until one is clear."""
    while tries:
        rule, index, other = heapq.heappop(tries)
        if index in standing:
            continue
        for move in RULES[rule](plots[index], standing[other]):
            if _clear(_moved(plots[index], move), grounds):
                return index, move
    return None


def carried(move: Move, points_m: Points) -> Points:
    """Carry points from a block's frame to the city's."""
    cos, sin = np.cos(move.turn_rad), np.sin(move.turn_rad)
    turned = points_m @ np.array([[cos, sin], [-sin, cos]])
    return turned + np.array([move.east_m, move.north_m])


def _borders(outline_m: Points, fronts: Sequence[Front]) -> list[Border]:
    closed = len(outline_m) > 2
    ends = np.roll(outline_m, -1, axis=0) if closed else outline_m[1:]
    sides: list[list[Front]] = [[] for _ in ends]
    for front in sorted(fronts, key=lambda front: front.rank):
        sides[front.side].append(front)
    streets = [side[0].street.casefold() if side else "" for side in sides]
    return [
        Border(
            street=streets[index],
            before=streets[index - 1] if closed or index else "",
            after=streets[(index + 1) % len(ends)]
            if closed or index + 1 < len(ends)
            else "",
            start_m=outline_m[index],
            end_m=ends[index],
            numbers=_numbers(sides[index]),
        )
        for index in range(len(ends))
        if streets[index]
    ]


def _numbers(side: Sequence[Front]) -> tuple[int, int] | None:
    known = [house_numbers(front.address) for front in side]
    some = [one for one in known if one is not None]
    if not some:
        return None
    rising = some[0][0] <= some[-1][0]
    return (some[0][0], some[-1][1]) if rising else (some[0][1], some[-1][0])


def _facing(one: Plot, other: Plot) -> list[Move]:
    """List the ways to stand opposite another block."""
    moves = []
    for theirs in other.borders:
        for mine in one.borders:
            opposite = None not in (mine.parity, theirs.parity) and (
                mine.parity != theirs.parity
            )
            if mine.street == theirs.street and opposite:
                moves.append(_opposite(mine, theirs))
    return moves


def _opposite(mine: Border, theirs: Border) -> Move:
    ahead = theirs.end_m - theirs.start_m
    out = np.array([ahead[1], -ahead[0]]) / np.hypot(*ahead)
    gap = street_width(theirs.street) * out
    at_start = bool(mine.before) and mine.before == theirs.after
    at_end = bool(mine.after) and mine.after == theirs.before
    if at_start == at_end:
        pivot, target = _middle(mine), _middle(theirs)
    elif at_start:
        pivot, target = mine.start_m, theirs.end_m
    else:
        pivot, target = mine.end_m, theirs.start_m
    return _move(_heading(theirs) + np.pi - _heading(mine), pivot, target + gap)


def _following(one: Plot, other: Plot) -> list[Move]:
    """List the ways to follow another block along a street."""
    moves = []
    for theirs in other.borders:
        for mine in one.borders:
            if mine.street == theirs.street and mine.parity == theirs.parity:
                moves += _beyond(mine, theirs)
    return moves


RULES = (_facing, _following)


def _beyond(mine: Border, theirs: Border) -> list[Move]:
    if mine.numbers is None or theirs.numbers is None:
        return []
    rises = _rise(mine) or _rise(theirs)
    apart = sum(mine.numbers) / 2 - sum(theirs.numbers) / 2
    if not rises or not apart:
        return []
    direction = np.sign(apart) * rises
    halves = (_length(mine) + _length(theirs)) / 2
    densities = [
        _length(one) / abs(one.numbers[1] - one.numbers[0])
        for one in (mine, theirs)
        if one.numbers and one.numbers[0] != one.numbers[1]
    ]
    distance = max(abs(apart) * float(np.mean(densities)), halves + STREET_M)
    ahead = (theirs.end_m - theirs.start_m) / _length(theirs)
    target = _middle(theirs) + direction * distance * ahead
    return [_move(_heading(theirs) - _heading(mine), _middle(mine), target)]


def _rise(border: Border) -> int:
    """Tell whether numbers rise along a border: 1, -1, or 0 where there is but one."""
    return int(np.sign(border.numbers[1] - border.numbers[0])) if border.numbers else 0


def _beside(one: Plot, grounds: Sequence[shapely.Geometry]) -> Move:
    if not grounds:
        return Move()
    right = float(shapely.total_bounds(np.array(grounds))[2])
    left = min(outline[:, 0].min() for outline in one.outlines_m)
    return Move(east_m=float(right - left + FALLBACK_GAP_M))


def _clear(one: Plot, grounds: Sequence[shapely.Geometry]) -> bool:
    mine, others = _ground(one), np.array(grounds)
    near = others[shapely.intersects(mine, others)]
    return not bool((shapely.area(shapely.intersection(mine, near)) > 1.0).any())


def _ground(one: Plot) -> shapely.Geometry:
    return shapely.union_all(
        [shapely.MultiPoint(outline).convex_hull for outline in one.outlines_m]
    )


def _moved(one: Plot, move: Move) -> Plot:
    borders = []
    for border in one.borders:
        start, end = carried(move, np.array([border.start_m, border.end_m]))
        borders.append(
            Border(
                border.street, border.before, border.after, start, end, border.numbers
            )
        )
    outlines = tuple(carried(move, outline) for outline in one.outlines_m)
    return Plot(one.block, outlines, tuple(borders))


def _move(turn_rad: float, pivot_m: Vector, target_m: Vector) -> Move:
    """Turn about a pivot and bring it to a target."""
    turn = float((turn_rad + np.pi) % (2 * np.pi) - np.pi)
    shift = target_m - carried(Move(turn), pivot_m[None])[0]
    return Move(turn, float(shift[0]), float(shift[1]))


def _middle(border: Border) -> Vector:
    return (border.start_m + border.end_m) / 2


def _length(border: Border) -> float:
    return float(np.hypot(*(border.end_m - border.start_m)))


def _heading(border: Border) -> float:
    return float(np.arctan2(*(border.end_m - border.start_m)[::-1]))
