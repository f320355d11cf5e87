"""Carry a front from the photo to its elevation: pixels, alpha, and what each rests on.

Nothing is painted here. Texels that the camera did not see stay black and are marked
for the inpainter: `INPAINTED` where something hides the front, or where its outline is
torn beside a neighbour or at the ground, `BEYOND_FRAME` outside the frame. `NOTHING` is
only what lies over the roof line (`skyline`).
"""

from typing import NamedTuple

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from nostalgin_core import evidence, homography
from nostalgin_core.arrays import Alpha, Corners, Gray, Mask, Matrix3
from nostalgin_core.records import Box, Facade, Photo
from nostalgin_core.rectify import skyline

MOST_PX = 4096  # the longest side of an elevation: the largest atlas's side
MOST_MAGNIFIED = 2.0  # texels per photo pixel of the quad
SOFT = 0.1  # alpha below which nothing of the front is in it
HALF = 127  # of 255: where a mask that is resampled ends


def size(quad: Corners, aspect: float) -> tuple[int, int]:
    """Choose an elevation's height and width so that it keeps the photo's resolution.

    Each side is at least as long as the longer of its two images, unless that would
    magnify the quad's area more than `MOST_MAGNIFIED` times (an oblique view, where
    the far end is stretched) or exceed `MOST_PX`.
    """
    top, right, bottom, left = np.hypot(*(np.roll(quad, -1, axis=0) - quad).T)
    height = max(left, right, max(top, bottom) / aspect)
    x, y = quad.T
    area = abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2
    height = min(height, np.sqrt(MOST_MAGNIFIED * area / aspect))
    height = min(height, MOST_PX, MOST_PX / aspect)
    return max(1, round(height)), max(1, round(height * aspect))


def photo_from_elevation(quad: Corners, shape: tuple[int, int]) -> Matrix3:
    """Map an elevation's outer edges onto a quad; pixel centres are whole numbers."""
    h, w = shape
    edges = np.array([[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]]) - 0.5
    return homography.between(edges, quad)


class Straight(NamedTuple):
    """A front straight on, as large as its quad calls for."""

    photo_from_elevation: Matrix3
    image: UInt8[np.ndarray, "eh ew"]
    alpha: Float[np.ndarray, "eh ew"]
    evidence: UInt8[np.ndarray, "eh ew"]


def straight(photo: Photo, front: Facade, quad: Corners, aspect: float) -> Straight:
    """Straighten a front by its quad, at the resolution that `size` chooses."""
    shape = size(quad, aspect)
    to_photo = photo_from_elevation(quad, shape)
    pixels = elevate(
        photo.image, front.alpha, front.amodal, to_photo, shape, frame=photo.frame
    )
    return Straight(to_photo, *pixels)


def elevate(
    image: Gray,
    alpha: Alpha,
    amodal: Mask,
    photo_from_elevation: Matrix3,
    shape: tuple[int, int],
    *,
    frame: Box,
) -> tuple[
    UInt8[np.ndarray, "eh ew"],
    Float[np.ndarray, "eh ew"],
    UInt8[np.ndarray, "eh ew"],
]:
    """Resample a front straight on, and say what each texel rests on.

    Pixels are interpolated bicubically, alpha and the amodal mask bilinearly.
    """
    h, w = shape

    def warped(values: np.ndarray, how: int) -> np.ndarray:
        return cv2.warpPerspective(
            values,
            photo_from_elevation,
            (w, h),
            flags=how | cv2.WARP_INVERSE_MAP,
            borderMode=cv2.BORDER_REPLICATE,
        )

    seen = warped(alpha.astype(np.float32), cv2.INTER_LINEAR)
    front = warped(amodal.astype(np.uint8) * 255, cv2.INTER_LINEAR) > HALF
    framed = within(frame, photo_from_elevation, shape)
    seen = np.where(framed, np.clip(seen, 0, 1), np.float32(0))
    rests_on = np.full(shape, evidence.NOTHING, np.uint8)
    rests_on[~skyline.over_roof(front)] = evidence.INPAINTED
    rests_on[seen > SOFT] = evidence.SOFT_EDGE
    rests_on[seen > evidence.SEEN] = evidence.PHOTOGRAPHED
    rests_on[~framed] = evidence.BEYOND_FRAME
    photographed = (rests_on == evidence.PHOTOGRAPHED) | (
        rests_on == evidence.SOFT_EDGE
    )
    gray = np.where(photographed, warped(image, cv2.INTER_CUBIC), np.uint8(0))
    return gray, np.where(photographed, seen, np.float32(0)), rests_on


def within(frame: Box, photo_from_elevation: Matrix3, shape: tuple[int, int]) -> Mask:
    """Tell which texels lie inside the exposed frame of the photo."""
    h, w = shape
    u, v, depth = photo_from_elevation
    row = np.arange(h)
    least, most = np.zeros(h), np.full(h, w - 1.0)
    sides = (
        u - frame.x0 * depth,
        (frame.x1 - 1) * depth - u,
        v - frame.y0 * depth,
        (frame.y1 - 1) * depth - v,
    )
    for a, b, c in sides:  # a x + b y + c >= 0 inside, so x is bounded in each row
        rest = b * row + c
        if a > 0:
            least = np.maximum(least, -rest / a)
        elif a < 0:
            most = np.minimum(most, -rest / a)
        else:
            most = np.where(rest >= 0, most, -1.0)
    x = np.arange(w)
    first = np.ceil(least).astype(np.intp)[:, None]
    return (x >= first) & (x <= np.floor(most).astype(np.intp)[:, None])
