"""Flat walls, drawn into a picture with exact depth.

A wall is a parallelogram in the world that wears a texture. Each pixel's ray is met
with each wall's plane; the nearest wall wins. The inverse depth of a plane is affine in
the pixel's coordinates, so all of it is a handful of sums.
"""

from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float, Int16, UInt8

from nostalgin_core.arrays import Gray, Matrix3
from nostalgin_core.scenes import lens
from nostalgin_core.scenes.lens import Camera, Places, Vector

NEAR_M = 0.4
FAR_M = 600.0
NOBODY = -1  # the label of sky and ground


@dataclass(frozen=True, slots=True, eq=False)
class Panel:
    """A flat thing in the world."""

    origin_m: Vector  # its lower left corner, seen from its front
    axes_m: Places  # two rows: its lower and its left edge, whole length
    label: int
    stray: Float[np.ndarray, "2 y x"] | None = None  # of its drawing (`flaws.stray`)


@dataclass(frozen=True, slots=True, eq=False)
class Canvas:
    """What the camera sees so far, drawn in place."""

    tone: Float[np.ndarray, "h w"]  # 0 to 255
    nearness: Float[np.ndarray, "h w"]  # one over the depth in metres; 0 is the sky
    label: Int16[np.ndarray, "h w"]


def empty(shape: tuple[int, int]) -> Canvas:
    """Make a canvas with nothing on it."""
    return Canvas(
        np.zeros(shape, np.float32),
        np.zeros(shape, np.float32),
        np.full(shape, NOBODY, np.int16),
    )


def bounds(
    camera: Camera, corners_m: Places, shape: tuple[int, int]
) -> tuple[int, int, int, int] | None:
    """Find the pixels that a flat polygon can touch, or None.

    The polygon is cut at the near plane first, for what is behind the camera has no
    pixel.
    """
    seen = lens.see(camera, corners_m)
    kept: list[np.ndarray] = []
    for here, there in zip(seen, np.roll(seen, -1, axis=0), strict=True):
        if here[2] >= NEAR_M:
            kept.append(here)
        if (here[2] - NEAR_M) * (there[2] - NEAR_M) < 0:
            share = (NEAR_M - here[2]) / (there[2] - here[2])
            kept.append(here + share * (there - here))
    if len(kept) < 3:
        return None
    lifted = np.array(kept) @ camera.matrix.T
    pixels = lifted[:, :2] / lifted[:, 2:]
    low = np.clip(np.floor(pixels.min(axis=0)), 0, [shape[1], shape[0]])
    high = np.clip(np.ceil(pixels.max(axis=0)) + 1, 0, [shape[1], shape[0]])
    if (high - low).min() < 1:
        return None
    return int(low[0]), int(low[1]), int(high[0]), int(high[1])


def draw(
    canvas: Canvas, camera: Camera, panel: Panel, texture: Callable[[], Gray]
) -> bool:
    """Draw a panel where nothing nearer stands; say whether any of it shows.

    With H = K [R u | R v | R o + t], H^-1 (x, y, 1) = (a, b, 1) / z: the place on the
    panel and the inverse depth at once. The texture is asked for only when it is seen.
    """
    u, v = panel.axes_m
    top = v if panel.stray is None else v * (1 + max(0.0, -panel.stray[1].min()))
    corners = panel.origin_m + np.stack([0 * u, u, u + top, top])
    box = bounds(camera, corners, canvas.tone.shape)
    if box is None:
        return False
    x0, y0, x1, y1 = box
    photo_from_unit = lens.photo_from_plane(camera, panel.origin_m, panel.axes_m)
    if abs(np.linalg.det(photo_from_unit)) < 1e-9:
        return False
    x = np.arange(x0, x1, dtype=np.float64)[None, :]
    y = np.arange(y0, y1, dtype=np.float64)[:, None]
    a, b, near = (
        (row[0] * x).astype(np.float32) + (row[1] * y + row[2]).astype(np.float32)
        for row in np.linalg.inv(photo_from_unit)
    )
    window = np.s_[y0:y1, x0:x1]
    mine = (a >= 0) & (a < near) & (b >= 0)
    mine &= (near > 1 / FAR_M) & (near > canvas.nearness[window])
    if panel.stray is None:
        mine &= b < near
    else:
        a, b = strayed(panel.stray, a, b, near)
        mine &= b < 1
    if not mine.any():
        return False
    nearest = float(near[mine].max())
    if panel.stray is None:
        seen = sample(texture(), photo_from_unit, box, nearest)
    else:
        seen = looked_up(shrunk(texture(), photo_from_unit, nearest), a, b)
    np.copyto(canvas.tone[window], seen, where=mine)
    np.copyto(canvas.nearness[window], near, where=mine)
    np.copyto(canvas.label[window], np.int16(panel.label), where=mine)
    return True


def sample(
    texture: Gray,
    photo_from_unit: Matrix3,
    box: tuple[int, int, int, int],
    nearest: float,
) -> Float[np.ndarray, "y x"]:
    """Warp a texture into a box of the photo, shrunk first where it is far.

    `nearest` is the greatest inverse depth.
    """
    texture = shrunk(texture, photo_from_unit, nearest)
    return cv2.warpPerspective(
        texture,
        box_from_texture(photo_from_unit, box, texture.shape),
        (box[2] - box[0], box[3] - box[1]),
        flags=cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
    ).astype(np.float32)


def shrunk(
    texture: Gray, photo_from_unit: Matrix3, nearest: float
) -> UInt8[np.ndarray, "_ _"]:
    """Shrink a texture to about the size that it has in the photo, if that is less.

    At the greatest inverse depth, `nearest`, one unit of the panel's height spans about
    |H e_b| times it in pixels.
    """
    h, w = texture.shape
    tall_px = float(np.linalg.norm(photo_from_unit[:2, 1])) * nearest
    shrink = max(tall_px / h, 0.02)
    if shrink >= 0.7:
        return texture
    size = (max(2, round(w * shrink)), max(2, round(h * shrink)))
    return cv2.resize(texture, size, interpolation=cv2.INTER_AREA).astype(np.uint8)


def strayed(
    stray: Float[np.ndarray, "2 _ _"],
    a: Float[np.ndarray, "y x"],
    b: Float[np.ndarray, "y x"],
    near: Float[np.ndarray, "y x"],
) -> tuple[Float[np.ndarray, "y x"], Float[np.ndarray, "y x"]]:
    """Find the place of the drawing that has strayed to each place of the panel.

    Takes a / z, b / z and 1 / z, gives a and b; what lies off the panel strays as its
    nearest edge does.
    """
    depth = 1 / np.maximum(near, np.float32(1 / FAR_M))
    a, b = a * depth, b * depth
    _, h, w = stray.shape
    column, row = np.clip(a, 0, 1) * w - 0.5, np.clip(b, 0, 1) * h - 0.5
    along, up = (
        cv2.remap(
            field.astype(np.float32),
            column,
            row,
            cv2.INTER_LINEAR,
            borderMode=cv2.BORDER_REPLICATE,
        )
        for field in stray
    )
    return a + along, b + up


def looked_up(
    texture: Gray, a: Float[np.ndarray, "y x"], b: Float[np.ndarray, "y x"]
) -> Float[np.ndarray, "y x"]:
    """Look places of a panel up in its texture."""
    h, w = texture.shape
    return cv2.remap(
        texture,
        np.clip(a, -1, 2) * w - np.float32(0.5),
        (1 - np.clip(b, -1, 2)) * h - np.float32(0.5),
        cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
    ).astype(np.float32)


def box_from_texture(
    photo_from_unit: Matrix3,
    box: tuple[int, int, int, int],
    shape: tuple[int, int],
) -> Matrix3:
    """Map texture pixels to pixels of a box of the photo."""
    shift = np.array([[1.0, 0, -box[0]], [0, 1.0, -box[1]], [0, 0, 1.0]])
    return shift @ photo_from_unit @ unit_from_texture(shape)


def unit_from_texture(shape: tuple[int, int]) -> Matrix3:
    """Map texture pixels (centres whole) to the unit square, up growing upwards."""
    h, w = shape
    return np.array([[1 / w, 0, 0.5 / w], [0, -1 / h, 1 - 0.5 / h], [0, 0, 1.0]])
