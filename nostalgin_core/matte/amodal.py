"""What a parked car hides at the foot of a front belongs to the front.

A front's *amodal* mask is its visible mask plus those occluder pixels that lie inside
the convex hull of what is visible and of a *ground line*, where the front meets the
pavement. The ground line is fitted to the feet of the columns that nothing hides; where
all are hidden, it runs halfway down what hides them, since a car's wheels stand nearer
to the camera, and so lower in the photo, than the wall behind.
"""

import cv2
import numpy as np
from jaxtyping import Bool, Float, Int

from nostalgin_core.arrays import Mask

NEAR_PX = 3  # an occluder this close below a foot hides it
FEWEST_FEET = 8  # columns; fewer do not make a line
STEEPEST = 0.6  # px a px; no pavement rises faster in a photo of a whole front


def amodal(visible: Mask, occluders: Mask) -> Mask:
    """Add to a front what hides it."""
    columns = np.flatnonzero(visible.any(0))
    if not len(columns):
        return visible.copy()
    ground = ground_line(visible, occluders)
    ends = np.array([columns[0], columns[-1]])
    feet = np.clip(np.polyval(ground, ends), 0, visible.shape[0] - 1)
    corners = np.column_stack([ends, feet])
    points = np.concatenate([_ends(visible), corners]).astype(np.float32)
    hull = np.round(cv2.convexHull(points)).astype(np.int32)
    covered = np.zeros(visible.shape, np.uint8)
    cv2.fillConvexPoly(covered, hull, 1)
    return visible | (covered.astype(bool) & occluders)


def ground_line(visible: Mask, occluders: Mask) -> Float[np.ndarray, " 2"]:
    """Return slope and intercept of y over x, where a front meets the ground."""
    columns = np.flatnonzero(visible.any(0))
    height = visible.shape[0]
    feet = height - 1 - np.argmax(visible[::-1, columns], axis=0)
    hidden = _covered(occluders, columns, feet)
    if np.count_nonzero(~hidden) >= max(FEWEST_FEET, len(columns) / 5):
        line = _fit(columns[~hidden], feet[~hidden].astype(float))
        # What stands free may be a side wing; nobody's foot floats above its wall.
        lowest = np.median(feet[~hidden] - np.polyval(line, columns[~hidden]))
        return line + np.array([0.0, lowest])
    return _fit(columns, _halfway(occluders, columns, feet))


def _covered(
    occluders: Mask, columns: np.ndarray, feet: np.ndarray
) -> Bool[np.ndarray, " n"]:
    """Tell which feet end at an occluder or at the photo's lower edge."""
    height = occluders.shape[0]
    below = [
        occluders[np.minimum(feet + d, height - 1), columns]
        for d in range(1, NEAR_PX + 1)
    ]
    return np.any(below, axis=0) | (feet >= height - NEAR_PX)


def _halfway(
    occluders: Mask, columns: np.ndarray, feet: np.ndarray
) -> Float[np.ndarray, " n"]:
    """Return, column by column, the middle of what lies below each foot."""
    rows = np.arange(occluders.shape[0])[:, None]
    deep = np.where(occluders[:, columns] & (rows > feet), rows, 0).max(0)
    return np.where(deep > feet, (feet + deep) / 2, feet)


def _fit(x: np.ndarray, y: np.ndarray) -> Float[np.ndarray, " 2"]:
    """Fit a line that a third of the points may miss: medians, then once again."""
    half = max(1, len(x) // 2)
    rest = len(x) - half
    slopes = (y[half:] - y[:rest]) / np.maximum(x[half:] - x[:rest], 1)
    slope = float(np.clip(np.median(slopes), -STEEPEST, STEEPEST)) if rest else 0.0
    return np.array([slope, float(np.median(y - slope * x))])


def _ends(mask: Mask) -> Int[np.ndarray, "n 2"]:
    """Return where a mask's rows begin and end: its convex hull needs no more."""
    rows = np.flatnonzero(mask.any(1))
    left = np.argmax(mask[rows], axis=1)
    right = mask.shape[1] - 1 - np.argmax(mask[rows, ::-1], axis=1)
    return np.stack([np.concatenate([left, right]), np.tile(rows, 2)], axis=1)
