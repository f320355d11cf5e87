"""A trimap says what is surely inside, surely outside, and where matting must decide.

The paper maps the network's probabilities from 5 % to 95 % to *unknown* (section 4.1).
Two mends: the network's grid is coarse, so a band that comes out thinner than its error
is widened, and where the network is unsure over a whole wall, the band is capped, for
matting can find edges, but not meaning.
"""

from typing import Final

import cv2
import numpy as np
from jaxtyping import Float32, UInt8

from nostalgin_core.arrays import Mask, Probability

BACKGROUND: Final = 0
UNKNOWN: Final = 128
FOREGROUND: Final = 255

Trimap = UInt8[np.ndarray, "h w"]


def trimap(
    probability: Probability,
    *,
    low: float = 0.05,
    high: float = 0.95,
    least_px: float = 3.0,
    most_px: float = 12.0,
) -> Trimap:
    """Turn probabilities into a trimap whose band holds the true edge.

    Within `least_px` of the contour at one half everything is unknown; beyond `most_px`
    of it nothing is. In between, what lies from `low` to `high` is. Distances inside
    are measured up to the array's rim only where the contour passes, so a mask that
    runs into the rim is not frayed there.
    """
    inside = probability >= 0.5
    away = np.abs(signed_distance(inside))
    result = inside.astype(np.uint8)
    result *= np.uint8(FOREGROUND)
    unsure = (probability > low) & (probability < high)
    result[(away <= least_px) | (unsure & (away <= most_px))] = UNKNOWN
    return result


def signed_distance(inside: Mask) -> Float32[np.ndarray, "h w"]:
    """Measure the distance to the contour in pixels: positive inside, negative outside.

    The contour runs between pixels, so no distance is below one half. Without a contour
    every pixel is infinitely far from it.
    """
    if inside.all() or not inside.any():
        far = np.inf if inside.all() else -np.inf
        return np.full(inside.shape, far, np.float32)
    cells = inside.astype(np.uint8)
    depth = cv2.distanceTransform(cells, cv2.DIST_L2, 5)
    depth -= cv2.distanceTransform(1 - cells, cv2.DIST_L2, 5)
    depth -= cells  # half a pixel less inside, half a pixel more outside
    depth += np.float32(0.5)
    return depth.astype(np.float32, copy=False)
