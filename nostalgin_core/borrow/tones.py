"""The tones of one print carried to another's, and how far both agree, place by place.

Two photographs of one front were printed darker or harder, and the light fell from
another side. On what both saw, the mean and the spread of their tones are compared
round each texel; far from there, over all that both saw.
"""

from typing import Final

import cv2
import numpy as np
from jaxtyping import Float32, Shaped

from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.views import View

SMALL_PX: Final = 160  # longest side at which slow changes are looked at
WIDE: Final = 0.08  # of the longer side: the standard deviation of what is round about
PRIOR: Final = 0.02  # of a place that both saw wholly: the weight of all the others
GAINS: Final = (0.5, 2.0)
WINDOW_PX: Final = 21  # in which patterns are compared
LEAST_SD: Final = 3.0  # gray levels: below, there is no pattern to compare

Map = Float32[np.ndarray, "h w"]


def toned(own: View, there: View) -> Map:
    """Give the tones of the own print to an elevation that lies over it."""
    both = own.known & there.known
    shape = own.image.shape
    size = small(shape)
    weight = shrunk(both.astype(np.float32), size)
    told = []
    for image in (own.image, there.image):
        values = image.astype(np.float32)
        mean = spread(shrunk(values * both, size), weight)
        square = spread(shrunk(values**2 * both, size), weight)
        told.append((mean, np.sqrt(np.maximum(square - mean**2, LEAST_SD**2))))
    (mean, sd), (mean_there, sd_there) = told
    gain = np.clip(sd / sd_there, *GAINS)
    gain, offset = (enlarged(one, shape) for one in (gain, mean - gain * mean_there))
    return gain * there.image + offset


def agreement(own: Gray, there: Map, both: Mask) -> Map:
    """Tell how alike two elevations are round each texel, from -1 to 1.

    It is the correlation in small windows, where both were seen, and elsewhere that of
    what lies nearest; far from all, that of all.
    """
    a, b = own.astype(np.float32), there.astype(np.float32)
    weight = boxed(both.astype(np.float32))
    safe = np.maximum(weight, 1e-3)
    mean_a, mean_b = boxed(a * both) / safe, boxed(b * both) / safe
    var_a = boxed(a * a * both) / safe - mean_a**2
    var_b = boxed(b * b * both) / safe - mean_b**2
    together = boxed(a * b * both) / safe - mean_a * mean_b
    floor = LEAST_SD**2
    like = together / np.sqrt(np.maximum(var_a, floor) * np.maximum(var_b, floor))
    # A bare wall bears no witness for or against.
    heard = both * (weight > 0.5) * np.clip(np.maximum(var_a, var_b) / 100.0, 0.02, 1)
    size = small(own.shape)
    part = shrunk(heard.astype(np.float32), size)
    mean = spread(shrunk((like * heard).astype(np.float32), size), part)
    return enlarged(mean, own.shape)


def boxed(values: Shaped[np.ndarray, "h w"]) -> Map:
    """Average over small windows."""
    return cv2.blur(
        values.astype(np.float32),
        (WINDOW_PX, WINDOW_PX),
        borderType=cv2.BORDER_CONSTANT,
    )


def small(shape: tuple[int, ...]) -> tuple[int, int]:
    """Choose a width and height at which slow changes are looked at."""
    scale = min(1.0, SMALL_PX / max(shape))
    return max(1, round(shape[1] * scale)), max(1, round(shape[0] * scale))


def shrunk(values: Shaped[np.ndarray, "h w"], size: tuple[int, int]) -> np.ndarray:
    """Scale a map down by averages."""
    return cv2.resize(values.astype(np.float32), size, interpolation=cv2.INTER_AREA)


def enlarged(values: np.ndarray, shape: tuple[int, ...]) -> Map:
    """Scale a slow map up again."""
    size = (shape[1], shape[0])
    return cv2.resize(values.astype(np.float32), size, interpolation=cv2.INTER_LINEAR)


def spread(weighted: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Average what is round about by weights, and where there is nothing, over all."""
    sigma = max(WIDE * max(weight.shape), 1.0)
    whole = float(weighted.sum()) / max(float(weight.sum()), 1e-6)
    sums, parts = (
        cv2.GaussianBlur(one, (0, 0), sigma, borderType=cv2.BORDER_CONSTANT)
        for one in (weighted, weight)
    )
    return (sums + PRIOR * whole) / (parts + PRIOR)
