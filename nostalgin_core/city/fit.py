"""A block's rings are laid into its outline, as a rigid body.

Points p along the outline are held against the nearest points c of the rings' sides,
and the rings turn and shift so that

    sum_p w(|p - c|) (n . (c + t + r J (c - o) - p))^2

grows least, with n the direction from c to p, o the rings' middle, J a quarter turn, r
and t small: point-to-line iterated closest points (Chen and Medioni 1992), reweighted
by w(d) = 1 / (1 + (d / s)^2) with a shrinking s. So a side that a map cuts off, a yard
that is open to the street or a building that the list does not know pulls at nothing.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from jaxtyping import Float

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


@dataclass(frozen=True, slots=True)
class Fit:
    """How rings lie in an outline."""

    move: Move
    misfit_m: float  # from the outline to the rings, in the median
    agreeing: float  # share of the outline that a ring passes
    cost_m: float  # mean distance, none counted beyond `FAR_M`


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
    found = [_settled(sides, points, turn) for turn in turns_rad]
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


def _settled(sides: Segments, points: Spots, turn_rad: float) -> Fit:
    move = about(turn_rad, *_boxed(sides, points, turn_rad))
    for reach in REACHES_M:
        for _ in range(ROUNDS):
            before = move
            move = _nearer(move, sides, points, reach)
            if _same(before, move):
                break
    apart = np.linalg.norm(points - _closest(_there(move, sides), points)[0], axis=1)
    return Fit(
        move,
        misfit_m=float(np.median(apart)),
        agreeing=float((apart < NEAR_M).mean()),
        cost_m=float(np.minimum(apart, FAR_M).mean()),
    )


def _same(a: Move, b: Move) -> bool:
    """Tell whether a step was too small to go on."""
    shift = abs(a.east_m - b.east_m) + abs(a.north_m - b.north_m)
    return abs(a.turn_rad - b.turn_rad) < STILL_RAD and shift < STILL_M


def _boxed(sides: Segments, points: Spots, turn_rad: float) -> tuple[Vector, Vector]:
    """Find the middles of both boxes that are square to the turned block."""
    there = carried(Move(turn_rad), np.eye(2))  # the block's axes, as rows
    own = sides.reshape(-1, 2)
    seen = points @ there.T
    middle = (seen.min(axis=0) + seen.max(axis=0)) / 2
    return (own.min(axis=0) + own.max(axis=0)) / 2, middle @ there


def _nearer(move: Move, sides: Segments, points: Spots, reach_m: float) -> Move:
    placed = _there(move, sides)
    touched, across = _closest(placed, points)
    gap = points - touched
    apart = np.linalg.norm(gap, axis=1)
    direction = np.where(
        apart[:, None] > 1e-9, gap / np.maximum(apart, 1e-9)[:, None], across
    )
    middle = placed.reshape(-1, 2).mean(axis=0)
    arm = touched - middle
    turned = np.column_stack([-arm[:, 1], arm[:, 0]])
    slope = np.column_stack([(direction * turned).sum(axis=1), direction])
    weight = 1.0 / (1.0 + (apart / reach_m) ** 2)
    normal = slope.T @ (slope * weight[:, None])
    normal += 1e-9 * np.trace(normal) * np.eye(3)  # where nothing tells, stay
    step = np.linalg.solve(normal, slope.T @ (weight * apart))
    origin = carried(move, np.zeros((1, 2)))[0]
    lever = carried(Move(float(step[0])), (origin - middle)[None])[0]
    shift = middle + lever + step[1:]
    return Move(move.turn_rad + float(step[0]), float(shift[0]), float(shift[1]))


def _there(move: Move, sides: Segments) -> Segments:
    return carried(move, sides.reshape(-1, 2)).reshape(-1, 2, 2)


def _closest(sides: Segments, points: Spots) -> tuple[Spots, Spots]:
    """Find the nearest point of any side to each point, and that side's normal."""
    start, way = sides[:, 0], sides[:, 1] - sides[:, 0]
    long = np.maximum((way**2).sum(axis=1), 1e-12)
    share = np.einsum("psk,sk->ps", points[:, None] - start, way) / long
    on = start + np.clip(share, 0.0, 1.0)[..., None] * way
    best = np.argmin(((points[:, None] - on) ** 2).sum(axis=2), axis=1)
    normal = np.column_stack([way[:, 1], -way[:, 0]]) / np.sqrt(long)[:, None]
    return on[np.arange(len(points)), best], normal[best]
