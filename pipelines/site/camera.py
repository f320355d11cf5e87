"""Where the photographer stood, in the block's metres: for the view from there."""

from collections.abc import Iterable, Mapping
from typing import Any, Final

import numpy as np
from jaxtyping import Float

from nostalgin_core.records import Assignment, Building, Standpoint, Texture, Wall

Json = dict[str, Any]
CENTIMETRE: Final = 2  # digits
PIXEL: Final = 1  # a tenth of one
TURN: Final = 6


def cameras(
    building: Building,
    assignments: Iterable[Assignment],
    stood: Mapping[Texture, Standpoint],
) -> dict[str, Json]:
    """Place the camera of each photo that shows a building, by the photo's key.

    A photo that shows two of its fronts is placed by the one that it shows surest.
    """
    walls = {wall.front_id: wall for wall in building.walls if wall.front_id}
    placed: dict[str, Json] = {}
    for one in sorted(assignments, key=lambda one: (-one.score, one.front_id)):
        texture = (one.photo, one.facade)
        if one.front_id in walls and texture in stood and one.photo not in placed:
            wall = walls[one.front_id]
            placed[one.photo] = {"front": one.front_id} | camera(stood[texture], wall)
    return placed


def camera(one: Standpoint, wall: Wall) -> Json:
    """Write a camera as plain values, in the frame of the block: east, north, up.

    `block_from_camera` is a rotation, row by row; the camera's axes are right, down and
    ahead. The wall as wide as the model has it and `roof_m` high, seen by this camera,
    is `quad_px`. `position_sd_m` holds what focal length and direction leave open.
    """
    block_from_front = axes(wall)
    width_m = float(np.hypot(*np.subtract(wall.end_m, wall.start_m)))
    position = [*wall.start_m, 0.0] + width_m * block_from_front @ one.position
    turn = block_from_front @ one.front_from_camera
    (focal, _, x), (_, _, y), _ = one.photo_from_camera
    return {
        "position_m": _rounded(position, CENTIMETRE),
        "position_sd_m": round(width_m * one.position_sd, CENTIMETRE),
        "block_from_camera": [_rounded(row, TURN) for row in turn],
        "focal_px": round(float(focal), PIXEL),
        "focal_sd_px": round(float(focal * one.focal_sd), PIXEL),
        "centre_px": _rounded([x, y], PIXEL),
        "size_px": list(one.size_px),
        "fov_deg": round(
            float(np.degrees(2 * np.arctan(one.size_px[1] / 2 / focal))), 1
        ),
        "quad_px": [_rounded(row, PIXEL) for row in one.quad_px],
        "roof_m": round(width_m * one.roof, CENTIMETRE),
    }


def axes(wall: Wall) -> Float[np.ndarray, "3 3"]:
    """Carry front axes (right, up, out) to the block's (east, north, up)."""
    ahead = np.subtract(wall.end_m, wall.start_m)
    east, north = ahead / max(float(np.hypot(*ahead)), 1e-9)
    return np.array([[east, 0.0, north], [north, 0.0, -east], [0.0, 1.0, 0.0]])


def _rounded(row: Iterable[float], digits: int) -> list[float]:
    return [round(float(value), digits) + 0.0 for value in row]
