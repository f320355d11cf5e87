"""How alike two elevations are where both were seen, and what that is worth."""

from typing import Final

import cv2
import numpy as np

from nostalgin_core.arrays import Gray, Matrix3
from nostalgin_core.views.marks import View

LONGEST_PX: Final = 400
COARSE: Final = 0.02  # of the longest side: tones wider than that differ by the print
FEWEST: Final = 400  # texels that both saw
WEIGHTS: Final = (-8.99, 3.18, 3.77)  # for 1, log(1 + support), likeness


def likeness(first: View, second: View, matrix: Matrix3) -> float:
    """Correlate two elevations, laid over each other, on what a camera saw in both.

    Returns -1 to 1; 0 where both saw hardly anything in common.
    """
    (image, known), (other, seen) = first, second
    scale = min(1.0, LONGEST_PX / max(other.shape))
    size = (max(1, int(other.shape[1] * scale)), max(1, int(other.shape[0] * scale)))
    small = np.diag([scale, scale, 1.0])
    here = cv2.warpPerspective(image, small @ matrix, size, flags=cv2.INTER_AREA)
    known_here = cv2.warpPerspective(known.astype(np.uint8), small @ matrix, size)
    there = cv2.resize(other, size, interpolation=cv2.INTER_AREA)
    seen_there = cv2.resize(
        seen.astype(np.uint8), size, interpolation=cv2.INTER_NEAREST
    )
    both = np.logical_and(known_here, seen_there)
    if both.sum() < FEWEST:
        return 0.0
    a, b = (detail(one)[both] for one in (here, there))
    a, b = a - a.mean(), b - b.mean()
    size_of_both = float(np.sqrt((a * a).sum() * (b * b).sum()))
    return float((a * b).sum()) / size_of_both if size_of_both > 0 else 0.0


def detail(image: Gray) -> np.ndarray:
    """Take from a picture the tones that change slowly."""
    values = image.astype(np.float32)
    return values - cv2.GaussianBlur(values, (0, 0), COARSE * LONGEST_PX)


def probability(support: float, alike: float) -> float:
    """Tell how probable it is that two elevations are of one front, even odds before.

    Fitted to the labelled fronts of blocks 996 and 997; `nostalgin evaluate views`
    holds it against labels.
    """
    constant, of_support, of_likeness = WEIGHTS
    odds = constant + of_support * np.log1p(support) + of_likeness * alike
    return float(1 / (1 + np.exp(-odds)))
