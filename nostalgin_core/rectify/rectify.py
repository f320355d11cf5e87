"""Straighten every front of a photo into an elevation, or say why it can't be done.

Lines, vanishing points, camera, quad, aspect ratio, homography, warp: section 3.3. All
fronts of a photo share the camera and the way up (`orient`, `upright`).
"""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from nostalgin_core import evidence, homography
from nostalgin_core.arrays import Corners, Matrix3, Points
from nostalgin_core.records import Elevation, Facade, Matted, Photo, Rejection
from nostalgin_core.rectify import (
    above,
    camera,
    foot,
    lines,
    orient,
    quad,
    upright,
    warp,
)

STAGE = "rectify"
LEAST_SIDE_PX = 16  # of a front: below, there is nothing to see on it
MOST_SKEWED = 1e9  # condition of a plane seen edge on
ASPECTS = (0.05, 20.0)
MOST_UNSURE_DEG = 10.0  # of the horizontal vanishing point: beyond, it is a guess
MOST_LEANING_DEG = 4.0  # of a side, in 95 of 100 cases: beyond, it isn't straightened
WITHIN = 1.96  # standard deviations: 95 of 100 cases
STEP = 1e-4  # of a parameter, for differences
MOST_BEYOND = 0.7  # of an elevation outside the frame
TOLD = 0.8  # the lines tell the focal length if they shrink the prior's spread to this

Parameters = Float[np.ndarray, " p"]


def rectify(
    photo: Photo, matted: Matted, *, detector: lines.Detector = lines.detect
) -> tuple[Elevation | Rejection, ...]:
    """Make one elevation, or one rejection, of each facade, in their order.

    A photo that was taken from above gives rejections alone.

    Another `detector` of lines may be given, to be compared with ours.
    """
    if not matted.facades:
        return ()
    oriented = orient.orient(photo, matted.facades, detector=detector)
    stands = [
        None if method is None else _stand(photo, facade, oriented.world, rank)
        for rank, (facade, method) in enumerate(
            zip(matted.facades, oriented.methods, strict=True)
        )
    ]
    feet = foot.feet(
        matted.facades, stands, foot.touches(matted.occluders, photo.frame)
    )
    views = [
        _straighten(photo, facade, oriented, rank, feet[rank])
        for rank, facade in enumerate(matted.facades)
    ]
    return above.refused(photo, matted, views, oriented.world)


def _straighten(
    photo: Photo,
    facade: Facade,
    oriented: orient.Oriented,
    rank: int,
    lowest: float | None,
) -> Elevation | Rejection:
    """Straighten one front; if its own direction leads nowhere, with a neighbour's."""
    method = oriented.methods[rank]
    if method is None:
        return _rejected(photo, facade, "too few lines")
    result = elevation(photo, facade, oriented.world, rank, method, lowest=lowest)
    if result or method == orient.NEIGHBOUR:
        return result
    sides = orient.outline(photo, facade)
    borrowed = orient.borrow(oriented.world, rank, sides)
    if borrowed is None:
        return result
    return elevation(photo, facade, borrowed, rank, orient.NEIGHBOUR) or result


def elevation(
    photo: Photo,
    facade: Facade,
    world: upright.Upright,
    rank: int,
    method: str,
    *,
    lowest: float | None = None,
) -> Elevation | Rejection:
    """Straighten one front with the world's camera, down to `lowest` in its plane."""
    sd_deg = upright.directions_sd_deg(world, rank)
    if sd_deg[0] > MOST_UNSURE_DEG:
        return _rejected(photo, facade, "direction unsure", f"{sd_deg[0]:.1f} degrees")
    points = quad.hull(facade.amodal)
    if len(points) < 3 or np.min(np.ptp(points, axis=0)) < LEAST_SIDE_PX:
        return _rejected(photo, facade, "facade too small")
    stand = _stand(photo, facade, world, rank)
    if stand is None:
        return _rejected(photo, facade, "quad degenerate")
    aspect, corners = _bounded(photo, world, stand, lowest)
    implausible = _implausible(photo, world, rank, corners, aspect)
    if implausible is not None:
        return _rejected(photo, facade, *implausible)
    straight = warp.straight(photo, facade, corners, aspect)
    beyond = float(np.mean(straight.evidence == evidence.BEYOND_FRAME))
    if beyond > MOST_BEYOND:
        return _rejected(photo, facade, "mostly beyond the frame", f"{beyond:.0%}")
    prior = camera.prior_focal_px(photo.frame)
    told = world.covariance[0, 0] < (TOLD * upright.LOG_FOCAL[1]) ** 2
    points_px = _to_photo(photo, upright.vanishing_points(world.parameters))
    return Elevation(
        facade=facade.index,
        image=straight.image,
        alpha=straight.alpha,
        evidence=straight.evidence,
        quad=corners,
        photo_from_elevation=straight.photo_from_elevation,
        vanishing_points=points_px[[rank + 1, 0]],
        focal_px=world.focal * prior if told else None,
        aspect=aspect,
        vanishing_sd_deg=sd_deg,
        focal_sd_px=world.focal * prior * float(np.sqrt(world.covariance[0, 0]))
        if told
        else None,
        aspect_sd=_aspect_sd(photo, world, rank, corners, aspect),
        method=method,
    )


def _implausible(
    photo: Photo, world: upright.Upright, rank: int, corners: Corners, aspect: float
) -> tuple[str, str] | None:
    """Tell, as a reason and a detail, why a quad is not to be believed, if it isn't."""
    lean = lean_sd_deg(photo, world, rank, corners)
    if lean > MOST_LEANING_DEG / WITHIN:
        return "direction unsure", f"sides may lean, sd {lean:.1f} degrees"
    if not ASPECTS[0] <= aspect <= ASPECTS[1]:
        return "aspect implausible", f"{aspect:.3g}"
    return None


def _rejected(photo: Photo, facade: Facade, reason: str, detail: str = "") -> Rejection:
    """Name what stopped a facade."""
    return Rejection(photo.key, STAGE, reason, detail, facade.index)


def _to_photo(photo: Photo, points: np.ndarray) -> np.ndarray:
    """Carry homogeneous points from units to photo pixels."""
    prior = camera.prior_focal_px(photo.frame)
    return points @ camera.matrix(prior, photo.frame).T


def _plane(photo: Photo, parameters: Parameters, rank: int, points: Points) -> Matrix3:
    """Map a front's plane to the photo: x to the right and y down, in equal units.

    The plane goes through the camera's axis at depth one. Its x axis is turned so that
    its normal points away from the camera towards the front, or it would be mirrored.
    """
    focal = np.exp(parameters[0]) * camera.prior_focal_px(photo.frame)
    photo_from_camera = camera.matrix(focal, photo.frame)
    directions = upright.axes(parameters)
    down, across = -directions[0], directions[rank + 1]
    towards = np.linalg.solve(photo_from_camera, [*points.mean(axis=0), 1.0])
    if np.cross(across, down) @ towards < 0:
        across = -across
    return photo_from_camera @ np.column_stack([across, down, [0.0, 0.0, 1.0]])


def _stand(
    photo: Photo, facade: Facade, world: upright.Upright, rank: int
) -> foot.Stand | None:
    """Bound a front in its plane, or None if that degenerates."""
    points = quad.hull(facade.amodal)
    if len(points) < 3:
        return None
    plane = _plane(photo, world.parameters, rank, points)
    if np.linalg.cond(plane) > MOST_SKEWED:
        return None
    bounds = quad.bounding(plane, points)
    if bounds is None:
        return None
    bounds = quad.trimmed(facade.amodal, plane, bounds)
    up = upright.axes(world.parameters)[0]
    azimuth = float(world.parameters[3 + rank])
    return foot.Stand(plane, bounds, float(up[2]), azimuth)


def _bounded(
    photo: Photo, world: upright.Upright, stand: foot.Stand, lowest: float | None
) -> tuple[float, Corners]:
    """Give the aspect ratio and the quad of a front, down to `lowest` if told."""
    bounds = stand.bounds.copy()
    if lowest is not None:
        bounds[3] = lowest
    corners = homography.apply(stand.photo_from_plane, quad.corners_of(bounds))
    focal = world.focal * camera.prior_focal_px(photo.frame)
    return camera.aspect(corners, focal, photo.frame), corners


def _aspect_sd(
    photo: Photo, world: upright.Upright, rank: int, corners: Corners, aspect: float
) -> float:
    """Carry the world's covariance on to the aspect ratio, to first order.

    The corners' middles of sides are held, and the rectangle round them is measured
    again with each parameter moved.
    """
    middles = (corners + np.roll(corners, -1, axis=0)) / 2
    slope = np.zeros(len(world.parameters))
    for i, flat in _moved(photo, world, rank, middles):
        width, height = flat[1, 0] - flat[3, 0], flat[2, 1] - flat[0, 1]
        slope[i] = (width / height - aspect) / STEP
    return float(np.sqrt(slope @ world.covariance @ slope))


def lean_sd_deg(
    photo: Photo, world: upright.Upright, rank: int, corners: Corners
) -> float:
    """Estimate by how far a front's left or right side may lean once straightened.

    In an oblique view a small error of the vertical point leans the far side by much
    more, so that this, and not the point's own error, tells whether a front is square.
    The quad's corners are held, and each parameter is moved; to first order.
    """
    slope = np.zeros((2, len(world.parameters)))
    for i, flat in _moved(photo, world, rank, corners):
        side = flat[[3, 2]] - flat[[0, 1]]  # upright in the world as it is
        slope[:, i] = np.arctan2(side[:, 0], side[:, 1]) / STEP
    variance = np.einsum("si,ij,sj->s", slope, world.covariance, slope)
    return float(np.degrees(np.sqrt(variance.max())))


def _moved(
    photo: Photo, world: upright.Upright, rank: int, points: Points
) -> Iterator[tuple[int, Points]]:
    """Carry points to a front's plane with each parameter that matters moved."""
    for i in (0, 1, 2, 3 + rank):
        moved = world.parameters.copy()
        moved[i] += STEP
        plane = _plane(photo, moved, rank, points)
        yield i, homography.apply(np.linalg.inv(plane), points)
