"""What is worth comparing in an elevation: points, and what the wall is like there.

Scale-invariant features (Lowe, 2004), all taken as upright, since an elevation is, and
compared by the roots of their histograms (Arandjelovic and Zisserman, 2012).
"""

from dataclasses import dataclass
from typing import Final, NamedTuple

import cv2
import numpy as np
from jaxtyping import Float32

from nostalgin_core import evidence
from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.records import Elevation

LONGEST_PX: Final = 500
SHORTEST_PX: Final = 16  # a narrower strip bears none
MOST: Final = 1500
RIM_PX: Final = 5  # beside what no camera saw, a mark is of the border alone
CONTRAST: Final = 3.0  # of the equalisation: prints differ, and so do skies


class View(NamedTuple):
    """An elevation, and where a camera saw it."""

    image: Gray
    known: Mask


def seen_on(elevation: Elevation) -> View:
    """Take from an elevation what a camera saw of it."""
    by_camera = (evidence.PHOTOGRAPHED, evidence.SOFT_EDGE)
    return View(elevation.image, np.isin(elevation.evidence, by_camera))


@dataclass(frozen=True, slots=True, eq=False)
class Marks:
    """The marks of one elevation."""

    at_px: Float32[np.ndarray, "n 2"]  # x, y
    size_px: Float32[np.ndarray, " n"]
    looks: Float32[np.ndarray, "n 128"]  # of length 1
    shape: tuple[int, int]  # of the elevation


def marks(view: View) -> Marks:
    """Find the marks of an elevation where a camera saw it."""
    image, known = view
    scale = min(2.0, LONGEST_PX / max(image.shape))
    how = cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC
    small = cv2.resize(image, None, fx=scale, fy=scale, interpolation=how)
    even = cv2.createCLAHE(CONTRAST, (8, 8)).apply(small)
    size = (even.shape[1], even.shape[0])
    seen = cv2.resize(known.astype(np.uint8), size, interpolation=cv2.INTER_NEAREST)
    seen = cv2.erode(seen, np.ones((RIM_PX, RIM_PX), np.uint8))
    sift = cv2.SIFT.create(MOST, contrastThreshold=0.02, edgeThreshold=20)
    every = sift.detect(even, seen) if min(even.shape) >= SHORTEST_PX else ()
    # One that is found in several directions is one mark: all count as upright.
    found = tuple({(one.pt, one.size): one for one in every}.values())
    for one in found:
        one.angle = 0.0
    looks = sift.compute(even, found)[1] if found else None
    if looks is None:
        looks = np.zeros((0, 128), np.float32)
    sums = np.maximum(looks.sum(axis=1, keepdims=True), np.finfo(np.float32).tiny)
    places = np.array([one.pt for one in found], np.float32).reshape(-1, 2)
    sizes = np.array([one.size for one in found], np.float32)
    return Marks(places / scale, sizes / scale, np.sqrt(looks / sums), image.shape)


def turned(found: Marks) -> Marks:
    """Give the marks that an elevation would bear in a mirror.

    A histogram has 4 rows and 4 columns of 8 directions: the columns change places, and
    so do left and right.
    """
    looks = found.looks.reshape(-1, 4, 4, 8)[:, :, ::-1, (4 - np.arange(8)) % 8]
    at_px = found.at_px * np.array([-1, 1], np.float32)
    at_px += np.array([found.shape[1] - 1, 0], np.float32)
    return Marks(at_px, found.size_px, looks.reshape(-1, 128), found.shape)
