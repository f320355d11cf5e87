"""Ground floors are darker than what stands above them: shop windows, awnings' shade.

A hole at a front's foot is filled from the floors above, so that its fill comes out too
bright, and the more so the farther from anything known. On labelled fronts of the time
that were hidden there on purpose, fills were brighter than the truth by 0.15 of
themselves, deep inside the hole and low on the front; by nothing at its border, where
the known texels tell.
"""

import cv2
import numpy as np

from nostalgin_core.arrays import Mask
from nostalgin_core.inpaint.smooth import Values

DARKER = 0.15  # of the fill, where nothing known tells otherwise
DEEP = 0.5  # of the front's width: so far from what is known, nothing tells
FLOOR = (0.25, 0.45)  # of the front's height: ground floor below, others above


def low(height: int) -> np.ndarray:
    """Tell how far each row belongs to the ground floor, from 0 to 1, top row first."""
    above = (height - np.arange(height) - 0.5) / height
    whole, none = FLOOR
    return ((none - above) / (none - whole)).clip(0, 1).astype(np.float32)


def darkening(hole: Mask) -> Values:
    """Give the factor by which a fill is to be darkened; 1 where the front is known.

    1 - 0.15 deep low, with `deep` the distance from what is known, up to half the
    front's width, as a share of that.
    """
    h, w = hole.shape
    if not hole.any() or hole.all():
        return np.ones((h, w), np.float32)
    far = cv2.distanceTransform(hole.astype(np.uint8), cv2.DIST_L2, 5)
    deep = np.minimum(far / (DEEP * w), 1)
    return (1 - DARKER * deep * low(h)[:, None]).astype(np.float32)
