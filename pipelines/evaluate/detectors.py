"""Other line detectors, to run through our later steps beside our own."""

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core import contours
from nostalgin_core.arrays import Gray

SHORTEST_PX = 8.0  # as for ours


def lsd(
    image: Gray, /, *settings: tuple[int, float]
) -> tuple[Float[np.ndarray, "_ 4"], ...]:
    """Find lines with OpenCV's LSD; it has no settings, so each gets the same."""
    found = cv2.createLineSegmentDetector().detect(image)[0]
    return (_long_enough(found),) * max(1, len(settings))


def hough(
    image: Gray, /, *settings: tuple[int, float]
) -> tuple[Float[np.ndarray, "_ 4"], ...]:
    """Find lines with OpenCV's probabilistic Hough transform on our own edges."""
    even = contours.even_out(image)
    mask, _ = contours.edges(even, *contours.canny_thresholds(even))
    found = cv2.HoughLinesP(
        mask.astype(np.uint8) * 255, 1, np.pi / 360, 20, minLineLength=12, maxLineGap=2
    )
    return (_long_enough(found),) * max(1, len(settings))


def _long_enough(found: np.ndarray | None) -> Float[np.ndarray, "_ 4"]:
    """Bring a detector's answer, if any, to rows of two ends."""
    if found is None:
        return np.empty((0, 4))
    rows = np.asarray(found, np.float64).reshape(-1, 4)
    length = np.hypot(rows[:, 2] - rows[:, 0], rows[:, 3] - rows[:, 1])
    return rows[length >= SHORTEST_PX]
