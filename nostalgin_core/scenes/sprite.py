"""Things in the street, cut out as soft shapes at one depth.

A thing is a list of flat patches, far ones first: a polygon in photo pixels and its
tone. Painting them gives a sprite, a small picture with alpha, that knows its depth.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.records import Category
from nostalgin_core.scenes import lens
from nostalgin_core.scenes.lens import Camera
from nostalgin_core.scenes.surface import NEAR_M, bounds, box_from_texture

Patch = tuple[Float[np.ndarray, "_ 2"], float]  # polygon in photo pixels, tone 0 to 255


@dataclass(frozen=True, slots=True, eq=False)
class Sprite:
    """One thing between the camera and the fronts."""

    category: Category | None  # None: a shadow, or what stands on a far roof
    depth_m: float
    corner_px: tuple[int, int]  # x, y of its upper left pixel
    tone: Float[np.ndarray, "h w"]
    alpha: Float[np.ndarray, "h w"]


def cut_out(
    category: Category | None,
    depth_m: float,
    patches: list[Patch],
    shape: tuple[int, int],
    *,
    blur_px: float = 0.0,
    drift_px: float = 0.0,
    cloth: np.random.Generator | None = None,
    opacity: float = 1.0,
) -> Sprite | None:
    """Paint patches into a sprite, clipped to the photo; None where nothing is left.

    `blur_px` softens it all round, for things out of focus; `drift_px` smears it
    sideways, for things that moved; `cloth` adds folds and grain.
    """
    margin = int(3 * blur_px + drift_px + 2)
    points = np.concatenate([patch[0] for patch in patches])
    low = np.clip(np.floor(points.min(axis=0)) - margin, 0, [shape[1], shape[0]])
    high = np.clip(np.ceil(points.max(axis=0)) + margin, 0, [shape[1], shape[0]])
    w, h = (high - low).astype(int)
    if min(w, h) < 2:
        return None
    tone = np.full((h, w), np.clip(np.mean([p[1] for p in patches]), 0, 255), np.uint8)
    alpha = np.zeros((h, w), np.uint8)
    for polygon, value in patches:
        fixed = np.round((polygon - low) * 16).astype(np.int32)
        gray = float(np.clip(value, 0, 255))
        cv2.fillPoly(tone, [fixed], gray, cv2.LINE_AA, 4)
        cv2.fillPoly(alpha, [fixed], 255.0, cv2.LINE_AA, 4)
    return finish(
        Sprite(
            category,
            depth_m,
            (int(low[0]), int(low[1])),
            tone.astype(np.float32),
            alpha.astype(np.float32) * np.float32(opacity / 255),
        ),
        blur_px=blur_px,
        drift_px=drift_px,
        cloth=cloth,
    )


def finish(
    sprite: Sprite,
    *,
    blur_px: float,
    drift_px: float,
    cloth: np.random.Generator | None,
) -> Sprite:
    """Fold, smear and soften a sprite; alpha and tone go through the same blur."""
    tone, alpha = sprite.tone, sprite.alpha
    if cloth is not None:
        h, w = tone.shape
        folds = cloth.standard_normal((max(2, h // 24), max(2, w // 6)), np.float32)
        soft = cv2.resize(folds, (w, h), interpolation=cv2.INTER_CUBIC)
        tone = tone * (1 + 0.07 * soft)
    weighted = tone * alpha
    if drift_px >= 2:
        size = (int(drift_px), 1)
        weighted, alpha = cv2.blur(weighted, size), cv2.blur(alpha, size)
    if blur_px > 0.3:
        weighted = cv2.GaussianBlur(weighted, (0, 0), blur_px)
        alpha = cv2.GaussianBlur(alpha, (0, 0), blur_px)
    tone = np.where(alpha > 1e-3, weighted / np.maximum(alpha, 1e-3), tone)
    return Sprite(
        sprite.category,
        sprite.depth_m,
        sprite.corner_px,
        np.clip(tone, 0, 255).astype(np.float32),
        np.clip(alpha, 0, 1).astype(np.float32),
    )


def pasted(
    category: Category,
    camera: Camera,
    shape: tuple[int, int],
    panel: tuple[np.ndarray, np.ndarray],
    sheet: tuple[np.ndarray, np.ndarray],
    *,
    blur_px: float = 0.0,
) -> Sprite | None:
    """Paste a flat picture (tone, alpha) into the world; None where it is not seen.

    `panel` is its lower left corner, and its lower and left edge as two rows.
    """
    origin_m, axes_m = panel
    u, v = axes_m
    corners = origin_m + np.stack([0 * u, u, u + v, v])
    depths = lens.see(camera, corners)[:, 2]
    if depths.min() < NEAR_M:
        return None
    box = bounds(camera, corners, shape)
    if box is None or min(box[2] - box[0], box[3] - box[1]) < 2:
        return None
    photo_from_unit = lens.photo_from_plane(camera, origin_m, axes_m)
    height_px = np.ptp(lens.project(camera, corners)[:, 1])
    shrink = min(1.0, height_px / sheet[0].shape[0])
    size = [max(2, round(side * shrink)) for side in sheet[0].shape[::-1]]
    small = [
        cv2.resize(s.astype(np.float32), size, interpolation=cv2.INTER_AREA)
        for s in sheet
    ]
    matrix = box_from_texture(photo_from_unit, box, (size[1], size[0]))
    out = (box[2] - box[0], box[3] - box[1])
    tone = cv2.warpPerspective(small[0], matrix, out, borderMode=cv2.BORDER_REPLICATE)
    alpha = cv2.warpPerspective(small[1], matrix, out)
    sprite = Sprite(category, float(depths.min()), (box[0], box[1]), tone, alpha)
    return finish(sprite, blur_px=blur_px, drift_px=0.0, cloth=None)
