"""A block's ground: its outlines, and the streets that its sides stand on."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from jaxtyping import Float
from shapely.geometry.base import BaseGeometry

from nostalgin_core.address import house_numbers, plain_name
from nostalgin_core.arrays import Points
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


def carried(move: Move, points_m: Points) -> Points:
    """Carry points from a block's frame to the city's."""
    cos, sin = np.cos(move.turn_rad), np.sin(move.turn_rad)
    turned = points_m @ np.array([[cos, sin], [-sin, cos]])
    return turned + np.array([move.east_m, move.north_m])


def moved(one: Plot, move: Move) -> Plot:
    """Carry a block's ground from its frame to the city's."""
    borders = []
    for border in one.borders:
        start, end = carried(move, np.array([border.start_m, border.end_m]))
        borders.append(replace(border, start_m=start, end_m=end))
    outlines = tuple(carried(move, outline) for outline in one.outlines_m)
    return Plot(one.block, outlines, tuple(borders))


def ground(one: Plot) -> BaseGeometry:
    """Give the ground that a block covers: the hull of each of its rings."""
    hulls = [shapely.MultiPoint(outline).convex_hull for outline in one.outlines_m]
    return hulls[0] if len(hulls) == 1 else shapely.union_all(hulls)


def centre(one: Plot) -> Vector:
    """Find the middle of a block's ground."""
    spot = ground(one).centroid
    return np.array([spot.x, spot.y])


def about(turn_rad: float, pivot_m: Vector, target_m: Vector) -> Move:
    """Turn about a pivot and bring it to a target."""
    turn = float((turn_rad + np.pi) % (2 * np.pi) - np.pi)
    shift = target_m - carried(Move(turn), pivot_m[None])[0]
    return Move(turn, float(shift[0]), float(shift[1]))


def middle(border: Border) -> Vector:
    """Find the middle of a side."""
    return (border.start_m + border.end_m) / 2


def length(border: Border) -> float:
    """Measure a side, in metres."""
    return float(np.hypot(*(border.end_m - border.start_m)))


def heading(border: Border) -> float:
    """Tell where a side leads: radians from east, anticlockwise."""
    return float(np.arctan2(*(border.end_m - border.start_m)[::-1]))


def _borders(outline_m: Points, fronts: Sequence[Front]) -> list[Border]:
    closed = len(outline_m) > 2
    ends = np.roll(outline_m, -1, axis=0) if closed else outline_m[1:]
    sides: list[list[Front]] = [[] for _ in ends]
    for front in sorted(fronts, key=lambda front: front.rank):
        sides[front.side].append(front)
    streets = [plain_name(side[0].street) if side else "" for side in sides]
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
