"""How well an elevation can be read: how far its texels are stretched, and how sharp.

Seen at a grazing angle a front is smeared along the street; in haze, or out of focus,
it keeps no detail. Both are told as numbers, so that the best photograph can be worn.
"""

from typing import Final

import cv2
import numpy as np

from nostalgin_core import evidence
from nostalgin_core.arrays import Mask
from nostalgin_core.records import Elevation

MOST_STRETCHED: Final = 3.0  # times as far one way as the other
GRID: Final = 64  # texels that are looked at, either way
MOST_MAGNIFIED: Final = 4.0  # of a sliver's few pixels, or blurs would never end
COARSER: Final = 2.0  # detail is what a blur twice as wide takes away


def stretched(view: Elevation) -> float:
    """Measure the share of what a camera saw that is stretched too far.

    The Jacobian of the map to the photo has singular values s >= t, of which s / t is
    the stretch: s t = |det|, s^2 + t^2 = its squared norm.
    """
    h, w = view.image.shape
    rows = np.unique(np.linspace(0, h - 1, GRID).astype(int))
    columns = np.unique(np.linspace(0, w - 1, GRID).astype(int))
    seen = by_camera(view)[np.ix_(rows, columns)]
    if not seen.any():
        return 0.0
    x, y = np.meshgrid(columns, rows)
    mapped = np.stack([x, y, np.ones_like(x)], axis=-1) @ view.photo_from_elevation.T
    points, depth = mapped[..., :2] / mapped[..., 2:], mapped[..., 2]
    of = view.photo_from_elevation
    slope = of[:2, :2] - points[..., None] * of[2, :2]
    slope /= depth[..., None, None]
    area = np.abs(np.linalg.det(slope))
    norm = (slope**2).sum(axis=(-2, -1))
    far = norm > (MOST_STRETCHED + 1 / MOST_STRETCHED) * area
    return float(far[seen].mean())


def sharpness(view: Elevation, photo_px: float) -> float:
    """Measure the contrast of what is as fine as the photo's pixels, in gray levels.

    `photo_px` are the pixels of the photo that show the front: an elevation that
    magnifies them is looked at in their size.
    """
    seen = view.evidence == evidence.PHOTOGRAPHED
    if not seen.any() or photo_px <= 0:
        return 0.0
    magnified = float(np.sqrt(np.count_nonzero(by_camera(view)) / photo_px))
    scale = min(max(1.0, magnified), MOST_MAGNIFIED)
    weight = seen.astype(np.float32)
    light = view.image * weight

    def blurred(sigma: float) -> np.ndarray:
        near = cv2.GaussianBlur(weight, (0, 0), sigma)
        return cv2.GaussianBlur(light, (0, 0), sigma) / np.maximum(near, 1e-3)

    fine = blurred(scale) - blurred(COARSER * scale)
    return float(np.sqrt(np.mean(np.square(fine[seen], dtype=np.float64))))


def by_camera(view: Elevation) -> Mask:
    """Tell which texels a camera saw."""
    return np.isin(view.evidence, (evidence.PHOTOGRAPHED, evidence.SOFT_EDGE))
