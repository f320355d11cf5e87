"""A blown-out spot inside a front hides it, though nothing stands there.

Lamps, reflections and light leaks burn round spots into the film in which nothing is
left of the wall. A spot is taken for one where at least `least` of the frame, nine
tenths of it inside a front's convex hull, is as good as white and fills half of its
enclosing circle: sky between roofs does not, and white walls keep their grain.

A network that sees a flare loses the front behind it. One that fills four fifths of its
circle can be told without any front (of 363 labelled photographs none shows such a
spot), so that it can be healed, halo and all, before the network looks.
"""

from collections.abc import Iterator, Sequence
from typing import Final

import cv2
import numpy as np

from nostalgin_core.arrays import Mask
from nostalgin_core.punch import roundness
from nostalgin_core.records import Box, Instance, Photo

WHITE: Final = 252
THINNEST_PX: Final = 9  # what is thinner is a reflection on a cornice
ROUND: Final = 0.5  # of the enclosing circle; a square fills 0.64
INSIDE: Final = 0.9
TOUCHING: Final = 0.25  # enough of a disc, which nothing else in a street is
HALO_PX: Final = 5  # round the spot, where little is left to see
LEAST: Final = 0.004  # of the frame
DISC: Final = 0.8  # of the enclosing circle: a flare whatever lies round it
VEIL: Final = 0.6  # of the radius: as far as a halo misleads the network


def flares(
    photo: Photo, instances: Sequence[Instance], *, least: float = LEAST
) -> tuple[Instance, ...]:
    """Return the blown-out spots inside fronts, as things of the category other."""
    x0, y0, x1, y1 = photo.frame
    cut = np.s_[y0:y1, x0:x1]
    spots = _spots(photo, least, ROUND)
    if not spots:
        return ()
    hulls = [
        _hull(one, photo.image.shape)[cut]
        for one in instances
        if one.category == "facade"
    ]
    return tuple(
        _instance(spot, photo, HALO_PX)
        for spot in spots
        if any((spot & hull).sum() >= _needed(spot) for hull in hulls)
    )


def _needed(spot: Mask) -> float:
    """Return how many of a spot's pixels must lie inside a front."""
    share = TOUCHING if roundness(spot) >= DISC else INSIDE
    return share * np.count_nonzero(spot)


def veils(photo: Photo, *, least: float = LEAST) -> tuple[Instance, ...]:
    """Return the roundest blown-out spots with their halos, wherever they lie."""
    return tuple(
        _instance(spot, photo, round(VEIL * np.sqrt(np.count_nonzero(spot) / np.pi)))
        for spot in _spots(photo, least, DISC)
    )


def _spots(photo: Photo, least: float, roundest: float) -> list[Mask]:
    """Return the spots in the frame that are white, large and round enough."""
    x0, y0, x1, y1 = photo.frame
    white = (photo.image[y0:y1, x0:x1] >= WHITE).astype(np.uint8)
    enough = least * white.size
    if np.count_nonzero(white) < enough:
        return []
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (THINNEST_PX,) * 2)
    opened = cv2.morphologyEx(white, cv2.MORPH_OPEN, kernel)
    return [s for s in _pieces(opened, enough) if roundness(s) >= roundest]


def _pieces(mask: np.ndarray, enough: float) -> Iterator[Mask]:
    """Yield the connected pieces that are large enough."""
    _, labels, stats, _ = cv2.connectedComponentsWithStats(mask)
    for i in range(1, len(stats)):
        if stats[i, cv2.CC_STAT_AREA] >= enough:
            yield labels == i


def _hull(front: Instance, shape: tuple[int, ...]) -> Mask:
    """Fill the convex hull of what is likelier front than not."""
    hull = np.zeros(shape, np.uint8)
    inside = np.argwhere(front.probability > 0.5)[:, ::-1]
    if len(inside):
        corners = (inside + np.array(front.box[:2])).astype(np.int32)
        cv2.fillConvexPoly(hull, cv2.convexHull(corners), 1)
    return hull > 0


def _instance(spot: Mask, photo: Photo, halo_px: int) -> Instance:
    """Make a spot, with its halo, a thing in the photo."""
    x0, y0, x1, y1 = photo.frame
    size = 2 * halo_px + 1
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size))
    whole = np.zeros(photo.image.shape, np.uint8)
    whole[y0:y1, x0:x1] = cv2.dilate(spot.astype(np.uint8), kernel)
    ys, xs = (np.flatnonzero(whole.any(axis=axis)) for axis in (1, 0))
    box = Box(int(xs[0]), int(ys[0]), int(xs[-1]) + 1, int(ys[-1]) + 1)
    part = whole[box.y0 : box.y1, box.x0 : box.x1]
    return Instance("other", 1.0, box, part.astype(np.float32))
