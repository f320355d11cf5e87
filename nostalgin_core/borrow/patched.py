"""Which view a hidden texel is taken from, and how it joins what is already there."""

from collections.abc import Sequence
from typing import Any, Final

import cv2
import numpy as np
from jaxtyping import Bool, Float32, UInt8

from nostalgin_core.arrays import Mask, Matrix3

SMOOTH_PX: Final = 6.0  # over which the worth of views is compared
FEATHER_PX: Final = 6.0  # inside what is filled: its tone runs over to the own
REACH_PX: Final = 24
RIVAL: Final = 0.75  # of the best view's worth, to lie beside it at a seam
AROUND_PX: Final = 12  # of a region that is parted: what it borders on
LEAST_SMALL: Final = 12  # texels: what is smaller is left to the inpainter

Map = Float32[np.ndarray, "h w"]


def sharpness(photo_from_own: Matrix3, shape: tuple[int, int]) -> Map:
    """Tell how many pixels of its photograph a view has for a texel, the worst way.

    It is the smaller singular value of the derivative: a view from the side is long in
    one direction and short in the other. More than one counts as one.
    """
    h, w = shape
    y, x = np.mgrid[0:h, 0:w].astype(np.float32)
    m = photo_from_own
    depth = m[2, 0] * x + m[2, 1] * y + m[2, 2]
    depth = np.where(np.abs(depth) < 1e-6, 1e-6, depth)
    u = (m[0, 0] * x + m[0, 1] * y + m[0, 2]) / depth
    v = (m[1, 0] * x + m[1, 1] * y + m[1, 2]) / depth
    a, b = (m[0, 0] - m[2, 0] * u) / depth, (m[0, 1] - m[2, 1] * u) / depth
    c, d = (m[1, 0] - m[2, 0] * v) / depth, (m[1, 1] - m[2, 1] * v) / depth
    square = a * a + b * b + c * c + d * d
    product = a * d - b * c
    least = (square - np.sqrt(np.maximum(square**2 - 4 * product**2, 0))) / 2
    return np.minimum(1.0, np.sqrt(np.maximum(least, 0))).astype(np.float32)


def chosen(worths: Sequence[Map], images: Sequence[Map]) -> UInt8[np.ndarray, "h w"]:
    """Choose for each texel the view of most worth, from 1; 0 where none has any.

    Where several are nearly as good, the seam between them runs where they look alike
    (graph cut: Kwatra et al., 2003).
    """
    smooth = []
    for worth in worths:
        there = (worth > 0).astype(np.float32)
        sums, parts = (cv2.GaussianBlur(o, (0, 0), SMOOTH_PX) for o in (worth, there))
        smooth.append(np.where(worth > 0, sums / np.maximum(parts, 1e-6), 0))
    stack = np.stack(smooth)
    best = stack.max(axis=0)
    masks = [(one > 0) & (one >= RIVAL * best) for one in stack]
    if sum(bool(mask.any()) for mask in masks) > 1:
        masks = cut(images, masks)
    shown = np.where(np.stack(masks), stack, 0)
    label = shown.argmax(axis=0).astype(np.uint8) + 1
    return np.where(shown.max(axis=0) > 0, label, 0).astype(np.uint8)


def cut(images: Sequence[Map], masks: Sequence[Mask]) -> list[Mask]:
    """Part views that lie over each other along seams where they look alike.

    Only where several lie is there anything to part.
    """
    several = np.sum(masks, axis=0) > 1
    if not several.any():
        return list(masks)
    here = around(several, AROUND_PX)
    given = [cv2.merge([image[here]] * 3) for image in images]
    parts = [mask[here].astype(np.uint8) * 255 for mask in masks]
    finder: Any = cv2.detail.GraphCutSeamFinder("COST_COLOR")  # its stub knows no array
    found = finder.find(given, [(0, 0)] * len(given), parts)
    parted = [mask.copy() for mask in masks]
    for mask, one in zip(parted, found, strict=True):
        mask[here] = (one.get() if isinstance(one, cv2.UMat) else one) > 0
    return parted


def around(mask: Mask, margin_px: int) -> tuple[slice, slice]:
    """Cut out what is true of a mask, with a margin."""
    rows, columns = (np.flatnonzero(mask.any(axis=axis)) for axis in (1, 0))
    return (
        slice(max(0, int(rows[0]) - margin_px), int(rows[-1]) + 1 + margin_px),
        slice(max(0, int(columns[0]) - margin_px), int(columns[-1]) + 1 + margin_px),
    )


def joined(image: Map, filled: Map, own: Mask, patch: Mask) -> Map:
    """Let the tone of a patch run over to what it borders on, inside the patch alone.

    What both show at the border differs by a little; that difference is carried some
    texels into the patch, and fades.
    """
    near = cv2.dilate(patch.astype(np.uint8), np.ones((5, 5), np.uint8)) > 0
    border = (own & near & ~patch).astype(np.float32)
    if not border.any():
        return filled
    sums, parts = (
        cv2.GaussianBlur(one.astype(np.float32), (0, 0), FEATHER_PX)
        for one in ((image - filled) * border, border)
    )
    off = sums / np.maximum(parts, 1e-4)
    away = cv2.distanceTransform((border == 0).astype(np.uint8), cv2.DIST_L2, 3)
    fade = np.exp(-away / FEATHER_PX) * (away < REACH_PX)
    return np.where(patch, filled + fade * off, filled).astype(np.float32)


def whole(patch: Mask) -> Bool[np.ndarray, "h w"]:
    """Leave out of a patch what is too small to show anything."""
    _, labels, stats, _ = cv2.connectedComponentsWithStats(
        patch.astype(np.uint8), connectivity=8
    )
    large = stats[:, cv2.CC_STAT_AREA] >= LEAST_SMALL
    large[0] = False
    return large[labels.astype(np.intp)]
