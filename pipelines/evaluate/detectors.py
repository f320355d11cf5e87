"""Other line detectors, to run through our later steps beside our own."""

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.rectify import contours

SHORTEST_PX = 8.0  # as for ours


def lsd(
    image: Gray, /, *settings: tuple[int, float], where: Mask | None = None
) -> tuple[Float[np.ndarray, "_ 4"], ...]:
    """Find lines with OpenCV's LSD; it has no settings, so each gets the same.

    It has no mask, either: lines whose middle lies outside `where` are left out.
    """
    found = cv2.createLineSegmentDetector().detect(image)[0]
    return (_long_enough(found, where),) * max(1, len(settings))


def hough(
    image: Gray, /, *settings: tuple[int, float], where: Mask | None = None
) -> tuple[Float[np.ndarray, "_ 4"], ...]:
    """Find lines with OpenCV's probabilistic Hough transform on our own edges."""
    even = contours.even_out(image)
    mask, _ = contours.edges(even, *contours.canny_thresholds(even), where=where)
    found = cv2.HoughLinesP(
        mask.astype(np.uint8) * 255, 1, np.pi / 360, 20, minLineLength=12, maxLineGap=2
    )
    return (_long_enough(found, where),) * max(1, len(settings))


def _long_enough(
    found: np.ndarray | None, where: Mask | None
) -> Float[np.ndarray, "_ 4"]:
    """Bring a detector's answer, if any, to rows of two ends."""
    if found is None:
        return np.empty((0, 4))
    rows = np.asarray(found, np.float64).reshape(-1, 4)
    length = np.hypot(rows[:, 2] - rows[:, 0], rows[:, 3] - rows[:, 1])
    rows = rows[length >= SHORTEST_PX]
    if where is None:
        return rows
    h, w = where.shape
    x, y = ((rows[:, :2] + rows[:, 2:]) / 2).T
    column = np.clip(np.rint(x), 0, w - 1).astype(np.intp)
    row = np.clip(np.rint(y), 0, h - 1).astype(np.intp)
    return rows[where[row, column]]
