"""A punched hole is a black or white disc, and hides what lay there.

Archives cancelled negatives with a punch; in a print the hole is white. Nothing else in
a street is so large, so extreme in tone, so evenly round and so sharply cut: a disc
fills its smallest enclosing circle, and all round it the photo is of another tone. On
363 labelled photographs six black holes filled 0.95 or more of their circles; of all
else as large and as black none filled 0.80, and of all as white none 0.65.
"""

from collections.abc import Iterator, Sequence
from typing import Final

import cv2
import numpy as np

from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.records import Box, Instance, Photo

BLACK: Final = 24  # scanned film is not quite black, nor is a watermark on it
WHITE: Final = 250
OTHER: Final = 30  # levels, by which what lies round a hole differs
DISC: Final = 0.88  # of the enclosing circle; real ones fill 0.95 or more
FREE: Final = 0.9  # of the ring round it must differ
SMALLEST: Final = 0.004  # of the frame: 45 px across in 560 x 840
LARGEST: Final = 0.06
RING_PX: Final = (4.0, 8.0)  # beyond the blurred edge
EDGE_PX: Final = 2  # the blurred edge belongs to the hole
REACH_PX: Final = 3  # of the known tones that a healed pixel is made of


def punches(photo: Photo) -> tuple[Instance, ...]:
    """Return the holes punched into a photo, as things of the category other."""
    x0, y0, x1, y1 = photo.frame
    image = photo.image[y0:y1, x0:x1]
    tones = (
        (image <= BLACK, image > BLACK + OTHER),
        (image >= WHITE, image < WHITE - OTHER),
    )
    return tuple(
        _instance(spot, photo.frame)
        for tone, other in tones
        for spot in _spots(tone)
        if roundness(spot) >= DISC and _set_off(spot, other) >= FREE
    )


def healed(photo: Photo, holes: Sequence[Instance]) -> Gray:
    """Fill holes with the tones round them: a network that sees them loses fronts."""
    if not holes:
        return photo.image
    lost = np.zeros(photo.image.shape, np.uint8)
    for hole in holes:
        x0, y0, x1, y1 = hole.box
        lost[y0:y1, x0:x1] |= (hole.probability > 0.5).astype(np.uint8)
    return cv2.inpaint(photo.image, lost, REACH_PX, cv2.INPAINT_TELEA)


def roundness(spot: Mask) -> float:
    """Return the share that a spot fills of the smallest circle round it."""
    _, radius = cv2.minEnclosingCircle(np.argwhere(spot)[:, ::-1].astype(np.int32))
    return float(np.count_nonzero(spot) / max(1.0, np.pi * radius**2))


def _spots(tone: Mask) -> Iterator[Mask]:
    """Yield the connected pieces of one tone that have a punch's size."""
    if np.count_nonzero(tone) < SMALLEST * tone.size:
        return
    # Letters of a watermark are closed; what hangs on a disc by a thread is cut off.
    cells = tone.astype(np.uint8)
    cells = cv2.morphologyEx(cells, cv2.MORPH_CLOSE, np.ones((5, 5), np.uint8))
    across = max(3, round(0.03 * min(tone.shape)) | 1)
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (across, across))
    cells = cv2.morphologyEx(cells, cv2.MORPH_OPEN, kernel)
    _, labels, stats, _ = cv2.connectedComponentsWithStats(cells)
    for i in range(1, len(stats)):
        if SMALLEST <= stats[i, cv2.CC_STAT_AREA] / tone.size <= LARGEST:
            yield labels == i


def _set_off(spot: Mask, other: Mask) -> float:
    """Return the share of the ring round a spot that is of another tone."""
    away = cv2.distanceTransform((~spot).astype(np.uint8), cv2.DIST_L2, 5)
    ring = (away > RING_PX[0]) & (away <= RING_PX[1])
    return float(np.mean(other[ring])) if ring.any() else 0.0


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
