"""A front as a drawing in relief: how light it is, and how far it stands out.

Ornaments are drawn once, on two planes; the light does the rest. So a window's reveal,
a cornice and a fire escape all cast the shadows that belong to them.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float

Plane = Float[np.ndarray, "h w"]
LIP_M = 0.03  # over which the edge of a shadow softens


@dataclass(frozen=True, slots=True, eq=False)
class Board:
    """A drawing in metres: x from the left end, up from the pavement."""

    albedo: Plane  # 0 to 1, share of the light given back
    relief_m: Plane  # out of the wall's plane, towards the street
    px_per_m: float


def blank(width_m: float, height_m: float, *, px_per_m: float) -> Board:
    """Make an empty drawing of this size."""
    shape = (max(8, round(height_m * px_per_m)), max(8, round(width_m * px_per_m)))
    return Board(np.full(shape, 0.4, np.float32), np.zeros(shape, np.float32), px_per_m)


def cut(
    board: Board, left_m: float, low_m: float, right_m: float, high_m: float
) -> tuple[slice, slice]:
    """Give the pixels of a rectangle, clipped to the drawing."""
    h, w = board.albedo.shape
    columns = np.clip(np.round(np.array([left_m, right_m]) * board.px_per_m), 0, w)
    rows = np.clip(np.round(h - np.array([high_m, low_m]) * board.px_per_m), 0, h)
    return slice(int(rows[0]), int(rows[1])), slice(int(columns[0]), int(columns[1]))


def box(
    board: Board,
    place: tuple[float, float, float, float],
    *,
    albedo: float | None = None,
    relief_m: float | None = None,
) -> None:
    """Draw a rectangle given as left, low, right, high."""
    where = cut(board, *place)
    if albedo is not None:
        board.albedo[where] = albedo
    if relief_m is not None:
        board.relief_m[where] = relief_m


def outline(
    board: Board, points_m: np.ndarray, *, albedo: float, relief_m: float | None
) -> None:
    """Draw a filled polygon, its points as rows of x and up."""
    h = board.albedo.shape[0]
    points = np.column_stack([points_m[:, 0], -points_m[:, 1]]) * board.px_per_m
    pixels = np.round(points + np.array([0.0, h])).astype(np.int32)
    cv2.fillPoly(board.albedo, [pixels], albedo)
    if relief_m is not None:
        cv2.fillPoly(board.relief_m, [pixels], relief_m)


def stroke(
    board: Board,
    start_m: tuple[float, float],
    end_m: tuple[float, float],
    *,
    wide_m: float,
    albedo: float,
    relief_m: float,
) -> None:
    """Draw a straight bar between two places given as x and up."""
    h = board.albedo.shape[0]
    ends = [
        (round(x * board.px_per_m), round(h - up * board.px_per_m))
        for x, up in (start_m, end_m)
    ]
    wide = max(1, round(wide_m * board.px_per_m))
    cv2.line(board.albedo, ends[0], ends[1], albedo, wide)
    cv2.line(board.relief_m, ends[0], ends[1], relief_m, wide)


def shadow(board: Board, sun: tuple[float, float, float]) -> Plane:
    """Say how far each place lies in the shadow of what stands out, 0 to 1.

    A place is dark where, on the way to the sun, something stands higher than the
    sun's ray: relief(p + s d) - s tan(elevation) > relief(p).
    """
    right, up, out = sun
    along = float(np.hypot(right, up))
    relief = board.relief_m
    best = relief.copy()
    if along < 1e-6:
        return np.zeros_like(relief)
    rise_m = out / along / board.px_per_m
    reach = int(min(np.ptp(relief) / rise_m, 2.5 * board.px_per_m)) + 1
    h, w = relief.shape
    buffer = np.empty_like(relief)
    for step in (*range(1, min(reach, 10) + 1), *range(12, reach + 1, 2)):
        dx, dy = round(step * right / along), round(-step * up / along)
        here = np.s_[max(0, -dy) : h - max(0, dy), max(0, -dx) : w - max(0, dx)]
        there = np.s_[max(0, dy) : h - max(0, -dy), max(0, dx) : w - max(0, -dx)]
        if best[here].size == 0:
            break
        ray = np.subtract(relief[there], np.float32(step * rise_m), out=buffer[here])
        np.maximum(best[here], ray, out=best[here])
    return np.clip((best - relief) / LIP_M, 0.0, 1.0)


def light(board: Board, sun: tuple[float, float, float], *, ambient: float) -> Plane:
    """Light the drawing: sun where it reaches, the sky everywhere.

    `sun` points from the wall to the sun as right, up, out of the wall; it is below
    the wall's horizon where `out` is not positive, and then the sky alone shines, as
    if from straight above.
    """
    relief = board.relief_m
    wide = 2 * round(0.4 * board.px_per_m) + 1
    deep = cv2.blur(cv2.blur(relief, (wide, wide)), (wide, wide)) - relief
    sky = ambient * np.clip(1.0 - 1.2 * np.maximum(deep, 0.0), 0.45, 1.0)
    lit = out_of_plane(relief, board.px_per_m)
    if sun[2] > 0.05:
        facing = np.clip(sun[2] + lit[0] * sun[0] + lit[1] * sun[1], 0.0, 1.3)
        sky = sky + (1.0 - ambient) * facing * (1.0 - shadow(board, sun))
    else:
        soft = cv2.GaussianBlur(
            shadow(board, (0.0, 0.75, 0.66)), (0, 0), 0.05 * board.px_per_m
        )
        sky = sky * (1.0 + 0.2 * np.clip(lit[1], -1.0, 1.0)) * (1.0 - 0.45 * soft)
    return np.clip(board.albedo * sky, 0.0, 1.0).astype(np.float32)


def out_of_plane(relief_m: Plane, px_per_m: float) -> tuple[Plane, Plane]:
    """Give the right and up parts of the wall's normal, for small slopes."""
    east = cv2.Sobel(relief_m, cv2.CV_32F, 1, 0, ksize=3, scale=px_per_m / 8)
    down = cv2.Sobel(relief_m, cv2.CV_32F, 0, 1, ksize=3, scale=px_per_m / 8)
    return np.clip(-east, -0.8, 0.8), np.clip(down, -0.8, 0.8)
