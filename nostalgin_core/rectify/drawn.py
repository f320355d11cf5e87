"""A quadrangle that somebody drew takes the place of ours.

Its corners are the image of the front's rectangle, so that its sides run to the two
vanishing points. Letters as in `camera`: `A` carries camera directions to photo pixels.
"""

from collections.abc import Sequence

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Corners, Homogeneous
from nostalgin_core.records import Box, Elevation, Facade, Matted, Photo, Rejection
from nostalgin_core.rectify import camera, upright, warp


def drawn(
    photo: Photo,
    matted: Matted,
    views: Sequence[Elevation | Rejection],
    corners: Corners,
    *,
    sd_px: float,
) -> tuple[Elevation | Rejection, ...]:
    """Straighten the front that a quad is of by that quad; the others stay as they are.

    It is the front that shares most with the quad, of two that share as much the
    target. `sd_px` is how surely a corner was drawn.
    """
    if not matted.facades:
        return tuple(views)
    shared = [common(one, corners) for one in matted.facades]
    key = [
        (share, one.target) for share, one in zip(shared, matted.facades, strict=True)
    ]
    best = max(range(len(key)), key=key.__getitem__)
    made = list(views)
    made[best] = by_hand(photo, matted.facades[best], views[best], corners, sd_px=sd_px)
    return tuple(made)


def common(one: Facade, corners: Corners) -> float:
    """Tell how much a front and a quad share, over what either covers."""
    inside = np.zeros(one.amodal.shape, np.uint8)
    cv2.fillConvexPoly(inside, np.rint(corners).astype(np.int32), 1)
    quad = inside.astype(bool)
    either = np.count_nonzero(one.amodal | quad)
    return np.count_nonzero(one.amodal & quad) / max(either, 1)


def by_hand(
    photo: Photo,
    one: Facade,
    view: Elevation | Rejection,
    corners: Corners,
    *,
    sd_px: float,
) -> Elevation:
    """Straighten a front by a quad, with the focal length that its photo told."""
    told = view if isinstance(view, Elevation) else None
    focal = told.focal_px if told else None
    focal_sd = told.focal_sd_px if told else None
    prior = camera.prior_focal_px(photo.frame)
    used, used_sd = focal or prior, focal_sd or prior * upright.LOG_FOCAL[1]
    aspect = camera.aspect(corners, used, photo.frame)
    straight = warp.straight(photo, one, corners, aspect)
    sd_deg, aspect_sd = spread(corners, used, used_sd, photo.frame, sd_px)
    return Elevation(
        facade=one.index,
        image=straight.image,
        alpha=straight.alpha,
        evidence=straight.evidence,
        quad=corners,
        photo_from_elevation=straight.photo_from_elevation,
        vanishing_points=vanishing_points(corners, used, photo.frame),
        focal_px=focal,
        aspect=aspect,
        vanishing_sd_deg=sd_deg,
        focal_sd_px=focal_sd,
        aspect_sd=aspect_sd,
        method="drawn by hand",
    )


def vanishing_points(corners: Corners, focal: float, frame: Box) -> Homogeneous:
    """Find where a quad's sides meet: level ones, then upright ones; A times unit."""
    a = camera.matrix(focal, frame)
    tl, tr, br, bl = np.column_stack([corners, np.ones(4)])
    meets = [
        np.cross(np.cross(tl, tr), np.cross(bl, br)),
        np.cross(np.cross(tl, bl), np.cross(tr, br)),
    ]
    units = [np.linalg.solve(a, point) for point in meets]
    return np.array([a @ (unit / np.linalg.norm(unit)) for unit in units])


def directions(corners: Corners, focal: float, frame: Box) -> Float[np.ndarray, "2 3"]:
    """Give the unit directions of a quad's level and upright sides, in the camera."""
    points = vanishing_points(corners, focal, frame)
    return np.linalg.solve(camera.matrix(focal, frame), points.T).T


def spread(
    corners: Corners, focal: float, focal_sd: float, frame: Box, sd_px: float
) -> tuple[tuple[float, float], float]:
    """Carry the errors of corners and focal length on to directions and aspect ratio.

    To first order, each moved by its standard deviation.
    """
    ways = directions(corners, focal, frame)
    ratio = camera.aspect(corners, focal, frame)
    turned, ratios = np.zeros(2), 0.0
    for place in range(8):
        moved = corners.copy()
        moved.flat[place] += sd_px
        cosines = np.sum(directions(moved, focal, frame) * ways, axis=1)
        turned += np.arccos(np.clip(np.abs(cosines), 0, 1)) ** 2
        ratios += (camera.aspect(moved, focal, frame) - ratio) ** 2
    ratios += (camera.aspect(corners, focal + focal_sd, frame) - ratio) ** 2
    sd_deg = np.degrees(np.sqrt(turned))
    return (float(sd_deg[0]), float(sd_deg[1])), float(np.sqrt(ratios))
