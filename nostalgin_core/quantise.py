"""Soft masks in 255 steps, so that an 8-bit image holds them exactly.

What a stage hands on is rounded here, in the plain loop and in the pipeline alike. So
an artifact that was written and read back equals the record it was made from, and a
run that was interrupted ends with the same bytes as one that was not.
"""

from dataclasses import replace

import numpy as np

from nostalgin_core.arrays import Alpha, Gray, Mask
from nostalgin_core.records import Elevation, Instance, Matted

STEPS = 255


def soft(values: Alpha) -> Alpha:
    """Round values of 0 to 1 to the nearest of 256 levels; doing it twice is once."""
    levels = np.clip(np.rint(np.asarray(values, np.float64) * STEPS), 0, STEPS)
    return (levels / STEPS).astype(np.float32)


def levels(image: Gray | Mask | Alpha) -> Gray:
    """Write a gray image, a mask or a soft mask as whole levels of 0 to 255."""
    if image.dtype == np.uint8:
        return image
    return np.rint(image.astype(np.float64) * STEPS).astype(np.uint8)


def instances(found: tuple[Instance, ...]) -> tuple[Instance, ...]:
    """Round the probabilities of every instance."""
    return tuple(replace(one, probability=soft(one.probability)) for one in found)


def matted(result: Matted) -> Matted:
    """Round the alphas of every facade."""
    facades = tuple(replace(one, alpha=soft(one.alpha)) for one in result.facades)
    return replace(result, facades=facades)


def elevation(one: Elevation) -> Elevation:
    """Round the alpha of an elevation."""
    return replace(one, alpha=soft(one.alpha))
