"""A wall without windows is no front, though the network takes one for it.

Party walls, laid bare where a neighbour is lower, or was pulled down, have a front's
outline and a front's tone, but neither rows of windows nor cornices, and the semantic
branch doubts them. So what the network calls a front is judged once more by what lies
inside its outline: a logistic function of the network's score, of what the branch says
of its pixels and of its border, of its size, and of how much there is to see on it. The
weights are fitted to hand labels (`export/fit_walls.py`).
"""

from collections.abc import Sequence
from typing import Final, NamedTuple

import cv2
import numpy as np
from jaxtyping import Float, Float32

from nostalgin_core.arrays import Mask
from nostalgin_core.records import Box, Instance, Photo
from nostalgin_core.segment.answer import Pixels

GRAIN_PX: Final = 0.7  # standard deviation of the blur before edges are measured
EDGE: Final = 0.03  # a pixel's change from which it is an edge; 1 is white beside black
NEAR_PX: Final = 5  # standard deviation of what counts as round a pixel
FLAT: Final = 0.02  # standard deviation of tones round a pixel, below which it is blank
BORDER_PX: Final = 2  # on either side of an outline
CORE_PX: Final = 3  # inside it

SURE: Final = 0.6  # from which a front is dropped: below, more fronts go than walls
WEIGHTS: Final = np.array(
    [5.65, -0.48, -3.18, -7.73, 4.13, -1.84, -4.35, -0.5, 0.24, 0.57]
)

_Plane = Float32[np.ndarray, "h w"]


class Planes(NamedTuple):
    """What the frame shows, pixel by pixel."""

    ground: _Plane
    front: _Plane
    end: _Plane
    across: _Plane  # 1 at an upright edge
    down: _Plane  # 1 at a level edge
    flat: _Plane  # 1 where nothing is to be seen
    tone: _Plane


NAMES: Final = (
    *("1", "score", "size", "front", "ground", "end at the border"),
    *("upright edges", "level edges", "flat", "tone"),
)


def without_walls(
    photo: Photo, things: Sequence[Instance], pixels: Pixels, *, sure: float = SURE
) -> tuple[Instance, ...]:
    """Drop the fronts that are walls with a probability above `sure`.

    What is wholly hidden is not judged: nothing is to be seen of it.
    """
    seen, hidden = planes(photo, pixels), before(things, photo.frame)
    return tuple(
        one
        for one in things
        if one.category != "facade"
        or likely(features(one, seen, hidden, photo.frame)) <= sure
    )


def likely(told: Float[np.ndarray, " 10"]) -> float:
    """Return the probability that a front of such features is a wall, 0 if unseen."""
    if told[NAMES.index("size")] == 0:
        return 0.0
    return float(1 / (1 + np.exp(-told @ WEIGHTS)))


def planes(photo: Photo, pixels: Pixels) -> Planes:
    """Measure what a wall is told by, all over the frame."""
    x0, y0, x1, y1 = photo.frame
    light = photo.image[y0:y1, x0:x1].astype(np.float32) / 255
    size = (x1 - x0, y1 - y0)
    ground, front, end = (
        cv2.resize(pixels[i], size, interpolation=cv2.INTER_LINEAR) for i in (0, 1, 3)
    )
    smooth = cv2.GaussianBlur(light, (0, 0), GRAIN_PX)
    edges = [
        np.abs(cv2.Sobel(smooth, cv2.CV_32F, dx, dy, ksize=1, scale=0.5)) > EDGE
        for dx, dy in ((1, 0), (0, 1))
    ]
    mean = cv2.GaussianBlur(smooth, (0, 0), NEAR_PX)
    square = cv2.GaussianBlur(smooth * smooth, (0, 0), NEAR_PX)
    flat = square - mean * mean < FLAT**2
    across, down, blank = (one.astype(np.float32) for one in (*edges, flat))
    return Planes(ground, front, end, across, down, blank, smooth)


def features(
    one: Instance, seen: Planes, hidden: Mask, frame: Box
) -> Float[np.ndarray, " 10"]:
    """Return what is weighed (`NAMES`), of what nothing hides.

    Args:
        one: A front.
        seen: Of the frame.
        hidden: What stands before anything, in the frame.
        frame: Where the frame lies in the photo.
    """
    x0, y0 = one.box.x0 - frame.x0, one.box.y0 - frame.y0
    h, w = one.probability.shape
    here = np.s_[y0 : y0 + h, x0 : x0 + w]
    mask = ((one.probability > 0.5) & ~hidden[here]).astype(np.uint8)
    inner = _shrunk(np.pad(mask, BORDER_PX), BORDER_PX)
    inner = inner[BORDER_PX:-BORDER_PX, BORDER_PX:-BORDER_PX]
    outer = cv2.dilate(mask, _square(BORDER_PX))
    border = (outer > 0) & (inner == 0)
    core = _shrunk(mask, CORE_PX) > 0
    core = core if core.any() else mask > 0
    size = np.sqrt(np.count_nonzero(mask) / hidden.size)

    def mean(plane: np.ndarray, where: np.ndarray) -> float:
        return float(plane[here][where].mean()) if where.any() else 0.0

    inside = (seen.front, seen.ground)
    shown = (seen.across, seen.down, seen.flat, seen.tone)
    return np.array(
        [
            1.0,
            one.score,
            size,
            *(mean(plane, core) for plane in inside),
            mean(seen.end, border),
            *(mean(plane, core) for plane in shown),
        ]
    )


def _square(reach_px: int) -> np.ndarray:
    return np.ones((2 * reach_px + 1,) * 2, np.uint8)


def _shrunk(mask: np.ndarray, by_px: int) -> np.ndarray:
    return cv2.erode(mask, _square(by_px), borderType=cv2.BORDER_REPLICATE)


def before(things: Sequence[Instance], frame: Box) -> Mask:
    """Lay what is no front into the frame."""
    result = np.zeros((frame.y1 - frame.y0, frame.x1 - frame.x0), bool)
    for one in things:
        if one.category != "facade":
            x0, y0 = one.box.x0 - frame.x0, one.box.y0 - frame.y0
            h, w = one.probability.shape
            result[y0 : y0 + h, x0 : x0 + w] |= one.probability > 0.5
    return result
