"""A rough overlay made exact: small patches of one elevation are found in the other.

Marks tell how two elevations lie over each other to a few texels. Here patches of the
own elevation are sought round their place in the other (normalised correlation, its
peak by a parabola), and a homography is fitted to where they were found (RANSAC): both
are planar views of one front, straightened each by its own slightly wrong quadrangle.
"""

from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Mask, Matrix3, Points
from nostalgin_core.views import View

LONGEST_PX: Final = 480  # patches are sought at this size
PATCH_PX: Final = 31
STEP_PX: Final = 20
REACHES_PX: Final = (10, 4)  # of the search: marks err by some texels, then few
KNOWN: Final = 0.9  # of a patch and of where it is sought
FLAT: Final = 6.0  # gray levels: what varies less has no place
PEAK: Final = 0.6  # correlation
NEAR_PX: Final = 1.5  # of the fitted homography, to agree with it
FEWEST: Final = 12  # patches that agree
LEAST_SHARE: Final = 0.35  # of those that were found
WIDEST: Final = 0.06  # of the longer side: corrections beyond are no correction

Band = tuple[Points, Points]


@dataclass(frozen=True, slots=True, eq=False)
class Aligned:
    """Where the texels of an elevation lie in another one of the same front."""

    matrix: Matrix3  # other from own, texels
    patches: int  # that agree
    share: float  # of those that were found
    error_px: float  # median distance of those that agree, in texels of the own


def aligned(own: View, other: View, matrix: Matrix3) -> Aligned | None:
    """Refine the homography from the own elevation to another; None: they don't fit."""
    scale = min(1.0, LONGEST_PX / max(own.image.shape))
    small = shrunk(own, scale)
    full_from_small = np.diag([1 / scale, 1 / scale, 1.0])
    whole = np.eye(3)  # all corrections so far
    for reach in REACHES_PX:
        there = warped(other, matrix @ full_from_small, small.image.shape)
        here, lies = sought(small, there, reach)
        found = fitted(here, lies)
        if found is None:
            return None
        correction, agree = found
        whole = whole @ correction
        matrix = matrix @ full_from_small @ correction @ np.linalg.inv(full_from_small)
        matrix = matrix / matrix[2, 2]
    if moved(whole, small.image.shape) > WIDEST * max(small.image.shape):
        return None
    gap = cv2.perspectiveTransform(here[None], correction)[0] - lies
    off = np.linalg.norm(gap, axis=1)[agree]
    share = float(agree.mean())
    if agree.sum() < FEWEST or share < LEAST_SHARE:
        return None
    return Aligned(matrix, int(agree.sum()), share, float(np.median(off)) / scale)


def shrunk(view: View, scale: float) -> View:
    """Scale an elevation down."""
    if scale == 1.0:
        return view
    size = (
        max(1, round(view.image.shape[1] * scale)),
        max(1, round(view.image.shape[0] * scale)),
    )
    known = cv2.resize(
        view.known.astype(np.uint8), size, interpolation=cv2.INTER_NEAREST
    )
    image = cv2.resize(view.image, size, interpolation=cv2.INTER_AREA)
    return View(image, known > 0)


def warped(
    other: View, other_from_own: Matrix3, shape: tuple[int, ...], px: int = 0
) -> View:
    """Resample an elevation as another lies, without the texels near its edges.

    `px` is how far what a camera saw is drawn in: beside what hides a front its tone
    is no more the front's.
    """
    size = (shape[1], shape[0])
    how = cv2.INTER_CUBIC | cv2.WARP_INVERSE_MAP
    image = cv2.warpPerspective(other.image, other_from_own, size, flags=how)
    sure = cv2.warpPerspective(
        other.known.astype(np.uint8) * 255,
        other_from_own,
        size,
        flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
    )
    known = (sure == 255).astype(np.uint8)
    if px:
        known = cv2.erode(
            known,
            np.ones((2 * px + 1,) * 2, np.uint8),
            borderType=cv2.BORDER_CONSTANT,
            borderValue=0,
        )
    return View(image, known > 0)


def sought(own: View, there: View, reach: int) -> Band:
    """Find patches of an elevation in another that lies nearly as it does.

    Returns where their centres are, and where they were found.
    """
    half, far = PATCH_PX // 2, PATCH_PX // 2 + reach
    here, lies = [], []
    for y, x in centres(own.known & there.known, far):
        patch = own.image[y - half : y + half + 1, x - half : x + half + 1]
        window = np.s_[y - far : y + far + 1, x - far : x + far + 1]
        if patch.std() < FLAT or there.known[window].mean() < KNOWN:
            continue
        like = cv2.matchTemplate(there.image[window], patch, cv2.TM_CCOEFF_NORMED)
        _, peak, _, (i, j) = cv2.minMaxLoc(like)
        if peak < PEAK or not (0 < i < 2 * reach and 0 < j < 2 * reach):
            continue
        here.append((x, y))
        lies.append(
            (
                x - reach + i + vertex(like[j, i - 1 : i + 2]),
                y - reach + j + vertex(like[j - 1 : j + 2, i]),
            )
        )
    points = (np.array(one, np.float64).reshape(-1, 2) for one in (here, lies))
    return tuple(points)  # type: ignore[return-value]


def centres(both: Mask, far: int) -> list[tuple[int, int]]:
    """List the centres of patches that both saw, row by row."""
    share = cv2.blur(
        both.astype(np.float32), (PATCH_PX, PATCH_PX), borderType=cv2.BORDER_CONSTANT
    )
    h, w = both.shape
    return [
        (y, x)
        for y in range(far, h - far, STEP_PX)
        for x in range(far, w - far, STEP_PX)
        if share[y, x] >= KNOWN
    ]


def vertex(three: Float[np.ndarray, "3"]) -> float:
    """Tell by how much a parabola through three values peaks beside the middle."""
    before, middle, after = (float(one) for one in three)
    bend = before - 2 * middle + after
    return 0.0 if bend >= 0 else max(-0.5, min(0.5, (before - after) / (2 * bend)))


def fitted(here: Points, lies: Points) -> tuple[Matrix3, np.ndarray] | None:
    """Fit a homography to patches, and tell which of them agree."""
    if len(here) < FEWEST:
        return None
    found, agree = cv2.findHomography(here, lies, cv2.RANSAC, NEAR_PX, maxIters=500)
    if found is None:
        return None
    return found, agree.ravel() > 0


def moved(correction: Matrix3, shape: tuple[int, ...]) -> float:
    """Tell how far a correction carries an elevation's corners at most, in texels."""
    h, w = shape
    corners = np.array([[[0.0, 0], [w, 0], [w, h], [0, h]]])
    off = cv2.perspectiveTransform(corners, correction) - corners
    return float(np.linalg.norm(off[0], axis=1).max())
