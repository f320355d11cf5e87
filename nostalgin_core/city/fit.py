"""A block's rings are laid into its outline, as a rigid body.

Points p along the outline are held against the nearest points c of the rings' sides,
and the rings turn and shift so that

    sum_p w(|p - c|) (n . (c + t + r J (c - o) - p))^2

grows least, with n the direction from c to p, o the rings' middle, J a quarter turn, r
and t small: point-to-line iterated closest points (Chen and Medioni 1992), reweighted
by w(d) = 1 / (1 + (d / s)^2) with a shrinking s. So a side that a map cuts off, a yard
that is open to the street or a building that the list does not know pulls at nothing.

All first turns go their rounds together. The outline is held against the rings in the
rings' own frame, where their sides stand still; there points are complex, x + iy.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from jaxtyping import Complex, Float

from nostalgin_core.city.plot import Move, Vector, about, carried

MOST_POINTS = 120  # along an outline
REACHES_M = (25.0, 8.0, 3.0)  # s, from first guess to last
ROUNDS = 6  # at each
YARD_M = 6.0  # further inside its hull, an outline goes round a yard
LEAST_OUTER = 0.3  # of an outline
NEAR_M = 3.0  # an outline's point that a ring passes this close agrees with it
STILL_M, STILL_RAD = 1e-3, 1e-5  # a step that is smaller is the last at its reach
FAR_M = 10.0  # beyond, one counts no more

Segments = Float[np.ndarray, "s 2 2"]
Part = Float[np.ndarray, "_ 2"]
Spots = Float[np.ndarray, "p 2"]
Ways = Complex[np.ndarray, " s"]
Turns = Float[np.ndarray, " t"]
Shifts = Complex[np.ndarray, " t"]
Seen = Complex[np.ndarray, "t p"]  # an outline's points from each pose of the rings


@dataclass(frozen=True, slots=True)
class Fit:
    """How rings lie in an outline."""

    move: Move
    misfit_m: float  # from the outline to the rings, in the median
    agreeing: float  # share of the outline that a ring passes
    cost_m: float  # mean distance, none counted beyond `FAR_M`


@dataclass(frozen=True, slots=True, eq=False)
class _Sides:
    """The rings' sides in their own frame, and what each round asks of them."""

    start: Ways
    way: Ways  # from start to end
    share: Ways  # times what a point is off the start: how far along it is, really
    across: Ways  # the normal
    middle: complex


def fit(
    rings_m: Sequence[Part], outline_m: Sequence[Part], turns_rad: Sequence[float]
) -> list[Fit]:
    """Lay rings into an outline, once from each first turn; the best comes first.

    `rings_m` are in their block's frame, `outline_m` (the same parts) in the city's.

    Raises:
        ValueError: if there is nothing to lay, or no turn to begin with.
    """
    if not turns_rad or not len(rings_m) or not len(outline_m):
        raise ValueError("no rings, no outline or no turn to begin with")
    sides, points = _sides(rings_m), along(outline_m)
    first = [about(turn, *_boxed(sides, points, turn)) for turn in turns_rad]
    found = _settled(sides, points, first)
    return sorted(found, key=lambda one: one.cost_m)


def quarters(rings_m: Sequence[Part], outline_m: Sequence[Part]) -> list[float]:
    """List the four turns that lay the rings' length along or across the outline's."""
    first = _lengthwise(outline_m) - _lengthwise(rings_m)
    return [float(first + quarter * np.pi / 2) for quarter in range(4)]


def nearest(turns_rad: Sequence[float], turn_rad: float) -> float:
    """Pick the turn that differs least."""
    return min(turns_rad, key=lambda one: abs(np.angle(np.exp(1j * (one - turn_rad)))))


def along(outline_m: Sequence[Part]) -> Spots:
    """Take points along an outline, equally far apart, but none round its yards.

    A yard that is open to the street makes an outline go in and out again: what lies
    further inside its hull is left out, if something remains.
    """
    lines = [shapely.LinearRing(part) for part in outline_m]
    hulls = [shapely.boundary(shapely.convex_hull(line)) for line in lines]
    whole = sum(line.length for line in lines)
    step = max(whole / MOST_POINTS, 1e-9)
    points, inside = [], []
    for line, hull in zip(lines, hulls, strict=True):
        spots = line.interpolate(np.arange(0.0, line.length, step))
        points.append(shapely.get_coordinates(spots))
        inside.append(shapely.distance(spots, hull))
    outer = np.concatenate(inside) < YARD_M
    every = np.concatenate(points)
    return every[outer] if outer.mean() > LEAST_OUTER else every


def _lengthwise(parts_m: Sequence[Part]) -> float:
    """Tell which way the longer sides of the smallest box round all parts lead."""
    box = shapely.MultiPoint(np.concatenate(list(parts_m))).minimum_rotated_rectangle
    corners = shapely.get_coordinates(box)
    if len(corners) < 5:  # a line has no box
        ends = corners[[0, -1]]
        return float(np.arctan2(*(ends[1] - ends[0])[::-1]))
    edges = np.diff(corners[:3], axis=0)
    longest = edges[int(np.argmax(np.hypot(*edges.T)))]
    return float(np.arctan2(*longest[::-1]))


def _sides(rings_m: Sequence[Part]) -> Segments:
    sides = []
    for ring in rings_m:
        ends = np.roll(ring, -1, axis=0) if len(ring) > 2 else ring[1:]
        sides.append(np.stack([ring[: len(ends)], ends], axis=1))
    return np.concatenate(sides)


def _settled(sides: Segments, points: Spots, first: Sequence[Move]) -> list[Fit]:
    whole, spots = _whole(sides), _complex(points)
    turn = np.array([one.turn_rad for one in first])
    shift = np.array([complex(one.east_m, one.north_m) for one in first])
    for reach in REACHES_M:
        moving = np.arange(len(first))
        for _ in range(ROUNDS):
            seen = _seen(spots, turn[moving], shift[moving])
            by, own = _step(whole, seen, reach)
            to = own * np.exp(1j * turn[moving])
            turn[moving] += by
            shift[moving] += to
            far = np.abs(to.real) + np.abs(to.imag) >= STILL_M
            moving = moving[far | (np.abs(by) >= STILL_RAD)]
            if not len(moving):
                break
    apart = np.abs(_gaps(whole, _seen(spots, turn, shift))[0])
    return [
        Fit(
            Move(float(by), float(to.real), float(to.imag)),
            misfit_m=float(np.median(off)),
            agreeing=float((off < NEAR_M).mean()),
            cost_m=float(np.minimum(off, FAR_M).mean()),
        )
        for by, to, off in zip(turn, shift, apart, strict=True)
    ]


def _whole(sides: Segments) -> _Sides:
    start, end = _complex(sides).T
    way = end - start
    square = np.maximum(np.abs(way) ** 2, 1e-12)
    across = -1j * way / np.sqrt(square)
    return _Sides(
        start, way, way.conj() / square, across, complex((start + end).mean() / 2)
    )


def _complex(points: Float[np.ndarray, "*_ 2"]) -> Complex[np.ndarray, "*_"]:
    return points[..., 0] + 1j * points[..., 1]


def _seen(spots: Complex[np.ndarray, " p"], turn: Turns, shift: Shifts) -> Seen:
    """Carry an outline's points back to the rings' frame, from each of their poses."""
    return (spots - shift[:, None]) * np.exp(-1j * turn)[:, None]


def _boxed(sides: Segments, points: Spots, turn_rad: float) -> tuple[Vector, Vector]:
    """Find the middles of both boxes that are square to the turned block."""
    there = carried(Move(turn_rad), np.eye(2))  # the block's axes, as rows
    own = sides.reshape(-1, 2)
    seen = points @ there.T
    middle = (seen.min(axis=0) + seen.max(axis=0)) / 2
    return (own.min(axis=0) + own.max(axis=0)) / 2, middle @ there


def _step(sides: _Sides, seen: Seen, reach_m: float) -> tuple[Turns, Shifts]:
    """Find by how much to turn and to shift the rings, in their own frame."""
    gap, across = _gaps(sides, seen)
    apart = np.abs(gap)
    direction = np.divide(gap, apart, out=across, where=apart > 1e-9)
    arm = seen - gap - sides.middle
    slope = np.empty((len(seen), 3, seen.shape[1]))
    slope[:, 1], slope[:, 2] = np.real(direction), np.imag(direction)
    slope[:, 0] = slope[:, 2] * np.real(arm) - slope[:, 1] * np.imag(arm)
    pull = slope / (1.0 + (apart / reach_m) ** 2)[:, None]
    normal = pull @ slope.swapaxes(1, 2)
    size = np.trace(normal, axis1=1, axis2=2)[:, None, None]
    normal += 1e-9 * size * np.eye(3)  # where nothing tells, stay
    step = np.linalg.solve(normal, pull @ apart[:, :, None])[..., 0]
    lever = sides.middle - sides.middle * np.exp(1j * step[:, 0])
    return step[:, 0], lever + _complex(step[:, 1:])


def _gaps(sides: _Sides, seen: Seen) -> tuple[Seen, Seen]:
    """Find the way from the nearest point of any side to each point; and its normal."""
    off = seen[..., None] - sides.start
    share = np.clip(np.real(off * sides.share), 0.0, 1.0)
    gap = (off - share * sides.way).reshape(-1, len(sides.way))
    best = np.argmin(np.real(gap) ** 2 + np.imag(gap) ** 2, axis=1)
    least = gap[np.arange(len(best)), best]
    return least.reshape(seen.shape), sides.across[best].reshape(seen.shape)
