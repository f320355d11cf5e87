"""A peer of our vanishing points, run as its makers document it.

`lu_vp_detect` 1.0 (Lu et al., "2-line exhaustive searching for real-time vanishing
point estimation in Manhattan world", WACV 2017) is told the focal length, draws pairs
of lines at random, and takes OpenCV's LSD lines of at least 30 px, its own default. It
expects what LSD returned before OpenCV 5, one row of four within another.
"""

import importlib.util
from functools import cache
from typing import Any

import cv2
import numpy as np

from nostalgin_core.arrays import Gray
from nostalgin_core.records import Box
from nostalgin_core.rectify import camera
from nostalgin_core.rectify.manhattan import Manhattan

SEED = 1337  # of its documentation's example


def installed() -> bool:
    """Tell whether the peer is there."""
    return importlib.util.find_spec("lu_vp_detect") is not None


def lu_vp_detect(
    image: Gray, *, focal_px: float, least_px: float = 30.0
) -> Manhattan | None:
    """Find three square directions with `lu_vp_detect`; None with too few lines.

    The rows are ordered as ours: up first. The points are at infinity where it says so,
    since its directions and not its image points are used.
    """
    h, w = image.shape
    middle = camera.centre(Box(0, 0, w, h))
    finder = _finder()(least_px, tuple(middle), focal_px, SEED)
    if len(_segments(image, least_px)) < 4:
        return None
    rays = finder.find_vps(image)[[2, 0, 1]].astype(np.float64)
    matrix = camera.matrix(focal_px, Box(0, 0, w, h))
    return Manhattan(rays @ matrix.T, focal_px)


def _segments(image: Gray, least_px: float) -> np.ndarray:
    """Find LSD's lines, whatever shape this OpenCV gives them."""
    found = cv2.createLineSegmentDetector(0).detect(image)[0]
    rows = np.empty((0, 4)) if found is None else np.asarray(found).reshape(-1, 4)
    return rows[np.hypot(rows[:, 2] - rows[:, 0], rows[:, 3] - rows[:, 1]) >= least_px]


@cache
def _finder() -> Any:
    """Make the peer's class, its reading of LSD's answer mended for OpenCV 5."""
    from lu_vp_detect import VPDetection  # pyright: ignore[reportMissingImports]

    private = "_VPDetection__"

    def detect_lines(self: Any, image: Gray) -> np.ndarray:
        lines = _segments(image, self.length_thresh)
        setattr(self, f"{private}lines", lines)
        return lines

    return type("Mended", (VPDetection,), {f"{private}detect_lines": detect_lines})
