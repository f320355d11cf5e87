"""A hole punched into a negative prints as a black disc, and hides what lay there.

Archives cancelled negatives with a punch. Nothing else in a street is so large, so
black, so evenly round and so sharply cut: a disc fills its smallest enclosing circle,
and all round it the photo is lighter. On 363 labelled photographs six holes filled 0.95
or more of their circles; of all other things as large and as black, none filled 0.80.
"""

from collections.abc import Iterator
from typing import Final

import cv2
import numpy as np

from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.records import Box, Instance, Photo

BLACK: Final = 24  # scanned film is not quite black, nor is a watermark on it
LIGHTER: Final = 30
DISC: Final = 0.88  # of the enclosing circle; real ones fill 0.95 or more
FREE: Final = 0.9  # of the ring round it must be lighter
SMALLEST: Final = 0.004  # of the frame: 45 px across in 560 x 840
LARGEST: Final = 0.06
RING_PX: Final = (4.0, 8.0)  # beyond the blurred edge
EDGE_PX: Final = 2  # the blurred edge belongs to the hole


def punches(photo: Photo) -> tuple[Instance, ...]:
    """Return the holes punched into a photo, as things of the category other."""
    x0, y0, x1, y1 = photo.frame
    image = photo.image[y0:y1, x0:x1]
    black = (image <= BLACK).astype(np.uint8)
    if np.count_nonzero(black) < SMALLEST * black.size:
        return ()
    # Letters of a watermark are closed; what hangs on a disc by a thread is cut off.
    black = cv2.morphologyEx(black, cv2.MORPH_CLOSE, np.ones((5, 5), np.uint8))
    across = max(3, round(0.03 * min(image.shape)) | 1)
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (across, across))
    spots = _pieces(cv2.morphologyEx(black, cv2.MORPH_OPEN, kernel))
    return tuple(
        _instance(spot, photo.frame)
        for spot in spots
        if roundness(spot) >= DISC and _set_off(spot, image) >= FREE
    )


def roundness(spot: Mask) -> float:
    """Return the share that a spot fills of the smallest circle round it."""
    _, radius = cv2.minEnclosingCircle(np.argwhere(spot)[:, ::-1].astype(np.int32))
    return float(np.count_nonzero(spot) / max(1.0, np.pi * radius**2))


def _pieces(black: np.ndarray) -> Iterator[Mask]:
    """Yield the connected pieces that have a punch's size."""
    _, labels, stats, _ = cv2.connectedComponentsWithStats(black)
    for i in range(1, len(stats)):
        if SMALLEST <= stats[i, cv2.CC_STAT_AREA] / black.size <= LARGEST:
            yield labels == i


def _set_off(spot: Mask, image: Gray) -> float:
    """Return the share of the ring round a spot that is lighter."""
    away = cv2.distanceTransform((~spot).astype(np.uint8), cv2.DIST_L2, 5)
    ring = (away > RING_PX[0]) & (away <= RING_PX[1])
    return float(np.mean(image[ring] > BLACK + LIGHTER)) if ring.any() else 0.0


def _instance(spot: Mask, frame: Box) -> Instance:
    """Make a hole, with its blurred edge, a thing in the photo."""
    size = 2 * EDGE_PX + 1
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size))
    whole = cv2.dilate(spot.astype(np.uint8), kernel)
    ys, xs = (np.flatnonzero(whole.any(axis=axis)) for axis in (1, 0))
    part = whole[ys[0] : ys[-1] + 1, xs[0] : xs[-1] + 1]
    x0, y0 = frame.x0 + int(xs[0]), frame.y0 + int(ys[0])
    box = Box(x0, y0, x0 + part.shape[1], y0 + part.shape[0])
    return Instance("other", 1.0, box, part.astype(np.float32))
