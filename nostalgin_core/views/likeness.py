"""How alike two elevations are where both were seen, and what that is worth."""

from typing import Final, NamedTuple

import cv2
import numpy as np
from jaxtyping import Bool, Float32

from nostalgin_core.arrays import Gray, Matrix3
from nostalgin_core.views import elsewhere
from nostalgin_core.views.marks import View

LONGEST_PX: Final = 400
COARSE_PX: Final = 8.0  # tones wider than that differ by the print
FEWEST: Final = 400  # texels that both saw
MARGIN: Final = 0.67  # how much of likeness is that it fits here and nowhere else
WEIGHTS: Final = (-5.04, 1.70, 3.63)  # for 1, log(1 + support), likeness


def likeness(first: View, second: View, matrix: Matrix3) -> float:
    """Correlate two elevations, laid over each other, on what a camera saw in both.

    What fits as well elsewhere, as the windows of a row do, tells little of one front:
    `elsewhere`'s margin is two parts of three. Returns -1 to 1; 0 where both saw hardly
    anything in common.
    """
    fine = common(first, second, matrix, LONGEST_PX)
    both = np.logical_and(fine.known, fine.seen)
    if both.sum() < FEWEST:
        return 0.0
    a, b = (one[both] - one[both].mean() for one in (fine.a, fine.b))
    size = float(np.sqrt((a * a).sum() * (b * b).sum()))
    alike = float((a * b).sum()) / size if size > 0 else 0.0
    coarse = common(first, second, matrix, elsewhere.LONGEST_PX)
    alone = elsewhere.margin(coarse.a, coarse.b, coarse.known, coarse.seen)
    return float(np.clip((1 - MARGIN) * alike + MARGIN * alone, -1, 1))


class Common(NamedTuple):
    """Two elevations in one frame: the details of each, and where a camera saw it."""

    a: Float32[np.ndarray, "h w"]
    b: Float32[np.ndarray, "h w"]
    known: Bool[np.ndarray, "h w"]
    seen: Bool[np.ndarray, "h w"]


def common(first: View, second: View, matrix: Matrix3, longest_px: int) -> Common:
    """Lay the first elevation over the second, both so large at most."""
    (image, known), (other, seen) = first, second
    scale = min(1.0, longest_px / max(other.shape))
    size = (max(1, int(other.shape[1] * scale)), max(1, int(other.shape[0] * scale)))
    small = np.diag([scale, scale, 1.0])
    here = cv2.warpPerspective(image, small @ matrix, size, flags=cv2.INTER_AREA)
    known_here = cv2.warpPerspective(known.astype(np.uint8), small @ matrix, size)
    there = cv2.resize(other, size, interpolation=cv2.INTER_AREA)
    seen_there = cv2.resize(
        seen.astype(np.uint8), size, interpolation=cv2.INTER_NEAREST
    )
    return Common(detail(here), detail(there), known_here > 0, seen_there > 0)


def detail(image: Gray) -> Float32[np.ndarray, "h w"]:
    """Take from a picture the tones that change slowly."""
    values = image.astype(np.float32)
    return values - cv2.GaussianBlur(values, (0, 0), COARSE_PX)


def probability(support: float, alike: float) -> float:
    """Tell how probable it is that two elevations are of one front, even odds before.

    Fitted to facades that the network found in block 996, and to painted fronts that
    share nothing but windows, the constant to what is claimed of the three blocks since
    a mark counts once; `nostalgin evaluate views` holds it against labels.
    """
    constant, of_support, of_likeness = WEIGHTS
    odds = constant + of_support * np.log1p(support) + of_likeness * alike
    return float(1 / (1 + np.exp(-odds)))
