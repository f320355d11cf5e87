"""A blown-out spot inside a front hides it, though nothing stands there.

Lamps, reflections and light leaks burn round spots into the film in which nothing is
left of the wall. A spot is taken for one where at least `least` of the frame, nine
tenths of it inside a front's convex hull, is as good as white and fills half of its
enclosing circle: sky between roofs does not, and white walls keep their grain.
"""

from collections.abc import Iterator, Sequence
from typing import Final

import cv2
import numpy as np

from nostalgin_core.arrays import Mask
from nostalgin_core.records import Box, Instance, Photo

WHITE: Final = 252
THINNEST_PX: Final = 9  # what is thinner is a reflection on a cornice
ROUND: Final = 0.5  # of the enclosing circle; a square fills 0.64
INSIDE: Final = 0.9
HALO_PX: Final = 5  # round the spot, where little is left to see


def flares(
    photo: Photo, instances: Sequence[Instance], *, least: float = 0.004
) -> tuple[Instance, ...]:
    """Return the blown-out spots inside fronts, as things of the category other."""
    x0, y0, x1, y1 = photo.frame
    cut = np.s_[y0:y1, x0:x1]
    white = (photo.image[cut] >= WHITE).astype(np.uint8)
    enough = least * white.size
    if np.count_nonzero(white) < enough:
        return ()
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (THINNEST_PX,) * 2)
    spots = [
        spot
        for spot in _pieces(cv2.morphologyEx(white, cv2.MORPH_OPEN, kernel), enough)
        if _round(spot)
    ]
    if not spots:
        return ()
    hulls = [
        _hull(one, photo.image.shape)[cut]
        for one in instances
        if one.category == "facade"
    ]
    return tuple(
        _instance(spot, photo)
        for spot in spots
        if any((spot & hull).sum() >= INSIDE * spot.sum() for hull in hulls)
    )


def _pieces(mask: np.ndarray, enough: float) -> Iterator[Mask]:
    """Yield the connected pieces that are large enough."""
    _, labels, stats, _ = cv2.connectedComponentsWithStats(mask)
    for i in range(1, len(stats)):
        if stats[i, cv2.CC_STAT_AREA] >= enough:
            yield labels == i


def _round(spot: Mask) -> bool:
    """Tell whether a spot fills enough of the smallest circle round it."""
    _, radius = cv2.minEnclosingCircle(np.argwhere(spot)[:, ::-1].astype(np.int32))
    return bool(np.count_nonzero(spot) >= ROUND * np.pi * radius**2)


def _hull(front: Instance, shape: tuple[int, ...]) -> Mask:
    """Fill the convex hull of what is likelier front than not."""
    hull = np.zeros(shape, np.uint8)
    inside = np.argwhere(front.probability > 0.5)[:, ::-1]
    if len(inside):
        corners = (inside + np.array(front.box[:2])).astype(np.int32)
        cv2.fillConvexPoly(hull, cv2.convexHull(corners), 1)
    return hull > 0


def _instance(spot: Mask, photo: Photo) -> Instance:
    """Make a spot, with its halo, a thing in the photo."""
    x0, y0, x1, y1 = photo.frame
    size = 2 * HALO_PX + 1
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size))
    whole = np.zeros(photo.image.shape, np.uint8)
    whole[y0:y1, x0:x1] = cv2.dilate(spot.astype(np.uint8), kernel)
    ys, xs = (np.flatnonzero(whole.any(axis=axis)) for axis in (1, 0))
    box = Box(int(xs[0]), int(ys[0]), int(xs[-1]) + 1, int(ys[-1]) + 1)
    part = whole[box.y0 : box.y1, box.x0 : box.x1]
    return Instance("other", 1.0, box, part.astype(np.float32))
