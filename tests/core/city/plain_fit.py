"""`fit` once more, a turn at a time and in the city's frame: its slow oracle."""

from collections.abc import Sequence

import numpy as np

from nostalgin_core.city import fit
from nostalgin_core.city.fit import Fit, Part, Segments, Spots
from nostalgin_core.city.plot import Move, Vector, about, carried


def plain_fit(
    rings_m: Sequence[Part], outline_m: Sequence[Part], turns_rad: Sequence[float]
) -> list[Fit]:
    """Lay rings into an outline as `fit` does; the best comes first."""
    sides = np.concatenate(
        [np.stack([ring, np.roll(ring, -1, axis=0)], axis=1) for ring in rings_m]
    )
    points = fit.along(outline_m)
    found = [_settled(sides, points, turn) for turn in turns_rad]
    return sorted(found, key=lambda one: one.cost_m)


def _settled(sides: Segments, points: Spots, turn_rad: float) -> Fit:
    move = about(turn_rad, *_boxed(sides, points, turn_rad))
    for reach in fit.REACHES_M:
        for _ in range(fit.ROUNDS):
            before = move
            move = _nearer(move, sides, points, reach)
            shift = abs(move.east_m - before.east_m) + abs(
                move.north_m - before.north_m
            )
            turned = abs(move.turn_rad - before.turn_rad)
            if turned < fit.STILL_RAD and shift < fit.STILL_M:
                break
    apart = np.linalg.norm(points - _closest(_there(move, sides), points)[0], axis=1)
    return Fit(
        move,
        misfit_m=float(np.median(apart)),
        agreeing=float((apart < fit.NEAR_M).mean()),
        cost_m=float(np.minimum(apart, fit.FAR_M).mean()),
    )


def _boxed(sides: Segments, points: Spots, turn_rad: float) -> tuple[Vector, Vector]:
    """Find the middles of both boxes that are square to the turned block."""
    there = carried(Move(turn_rad), np.eye(2))
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
    normal += 1e-9 * np.trace(normal) * np.eye(3)
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
