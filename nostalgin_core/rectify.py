"""Straighten every front of a photo into an elevation, or say why it can't be done.

Lines, vanishing points, camera, quad, aspect ratio, homography, warp: section 3.3. All
fronts of a photo share the camera and the way up (`upright`).
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from nostalgin_core import camera, homography, lines, quad, upright, vanish, warp
from nostalgin_core.arrays import Corners, Lines, Mask, Matrix3, Points
from nostalgin_core.records import Elevation, Facade, Matted, Photo, Rejection

STAGE = "rectify"
MARGIN_PX = 2  # an outline's own lines lie just outside as often as inside
LEAST_INSIDE = 0.5  # of a line
HIDDEN = 0.5  # alpha up to which something else is what the camera saw
LEAST_SIDE_PX = 16  # of a front: below, there is nothing to see on it
LEAST_LINES = 3.0  # whose weights support a front's horizontal
BORROWED = 0.85  # of its own votes are enough for a direction that the street has
WELL_KNOWN_DEG = 1.5  # the azimuth of a front that others may borrow from
MOST_SKEWED = 1e9  # condition of a plane seen edge on
ASPECTS = (0.05, 20.0)
TOLD = 0.8  # the lines tell the focal length if they shrink the prior's spread to this
BOTH = "two vanishing points"
UPRIGHT = "upright camera assumed"

Parameters = Float[np.ndarray, " p"]


@dataclass(frozen=True, slots=True, eq=False)
class Signal:
    """The lines that speak for one front, in units."""

    strict: Float[np.ndarray, "_ 4"]
    loose: Lines
    omega: Float[np.ndarray, " n"]
    length_px: Float[np.ndarray, " n"]

    @property
    def weights(self) -> Float[np.ndarray, " n"]:
        """Weigh the loose lines' votes: length times the share inside the front."""
        return self.omega * self.length_px


def rectify(photo: Photo, matted: Matted) -> tuple[Elevation | Rejection, ...]:
    """Make one elevation, or one rejection, of each facade, in their order."""
    if not matted.facades:
        return ()
    clear = [unhidden(facade) for facade in matted.facades]
    anywhere = np.any(clear, axis=0)
    found = detect(photo, anywhere & _framed(photo))
    signals = [signal(photo, found, mask) for mask in clear]
    world, seen, method = orient(signals, vertical(signal(photo, found, anywhere)))
    results = []
    rank = 0
    for facade, has in zip(matted.facades, seen, strict=True):
        if not has or world is None:
            results.append(_rejected(photo, facade, "too few lines"))
            continue
        results.append(elevation(photo, facade, world, rank, method))
        rank += 1
    return tuple(results)


def _framed(photo: Photo) -> Mask:
    """Tell where the exposed frame is, without its own edge, which is a long line."""
    x0, y0, x1, y1 = photo.frame
    inner = np.zeros(photo.image.shape, bool)
    edge = MARGIN_PX + 2
    inner[y0 + edge : y1 - edge, x0 + edge : x1 - edge] = True
    return inner


def unhidden(facade: Facade) -> Mask:
    """Tell where a line may speak for a front: on it and its outline, off occluders.

    The outline of what stands before the front lies as close to the front as the
    front's own, so holes grow by the margin and take it away.
    """
    hole = facade.amodal & (facade.alpha <= HIDDEN)
    return vanish.grown(facade.amodal, MARGIN_PX) & ~vanish.grown(hole, MARGIN_PX)


def detect(
    photo: Photo, where: Mask
) -> tuple[Float[np.ndarray, "_ 4"], Float[np.ndarray, "_ 4"]]:
    """Find the strict and the loose lines inside `where`, in photo pixels."""
    strict, loose = lines.detect(photo.image, lines.STRICT, lines.LOOSE, where=where)
    return strict, loose


def signal(
    photo: Photo,
    found: tuple[Float[np.ndarray, "_ 4"], Float[np.ndarray, "_ 4"]],
    mask: Mask,
) -> Signal:
    """Pick the lines of a front: those with at least half their length in its mask."""
    strict, loose = found
    strict = strict[vanish.inside(strict, mask) >= LEAST_INSIDE]
    omega = vanish.inside(loose, mask)
    loose, omega = loose[omega >= LEAST_INSIDE], omega[omega >= LEAST_INSIDE]
    where = camera.centre(photo.frame), camera.prior_focal_px(photo.frame)
    return Signal(
        vanish.to_unit(strict, *where),
        vanish.to_unit(loose, *where),
        omega,
        vanish.lengths(loose),
    )


def vertical(everywhere: Signal) -> tuple[Float[np.ndarray, "3"], float]:
    """Find the vertical vanishing point that all fronts share, in units."""
    return vanish.best_vertical(everywhere.strict, everywhere.loose, everywhere.weights)


def orient(
    signals: list[Signal], vertical: tuple[Float[np.ndarray, "3"], float]
) -> tuple[upright.Upright | None, list[bool], str]:
    """Fit the upright world to all fronts that have a horizontal direction.

    Each front first chooses for itself. Once the camera is known, each may choose
    again, between its own direction, those of the other fronts, and the ones square to
    them; if any does, all are fitted again.

    Returns: the world, which fronts are part of it, and how it was found.
    """
    up, share = vertical
    chosen = [vanish.best_horizontal(up, s.strict, s.loose, s.weights) for s in signals]
    seen = [c is not None for c in chosen]
    kept = [s for s, has in zip(signals, seen, strict=True) if has]
    if not kept:
        return None, seen, BOTH
    start = upright.start(up, np.array([c for c in chosen if c is not None]))
    world = _fit(start, kept)
    again = _choose_again(world, kept)
    if not np.array_equal(again, world.parameters):
        world = _fit(again, kept)
    return world, seen, BOTH if share > 0 else UPRIGHT


def _fit(parameters: Parameters, signals: list[Signal]) -> upright.Upright:
    """Fit the world to the lines of all fronts, each open to up and to its own."""
    front = np.repeat(np.arange(len(signals)), [len(s.loose) for s in signals])
    open_to = np.arange(len(signals) + 1) == front[:, None] + 1
    open_to[:, 0] = True
    return upright.fit(
        parameters,
        np.vstack([s.loose for s in signals]),
        open_to,
        np.concatenate([s.omega for s in signals]),
        np.concatenate([s.length_px for s in signals]),
    )


def _choose_again(world: upright.Upright, signals: list[Signal]) -> Parameters:
    """Let each front vote between its own azimuth and those of better known fronts.

    A borrowed azimuth needs only `BORROWED` of the own one's votes, since the street
    is evidence as well.
    """
    parameters = world.parameters.copy()
    theta = world.parameters[3:]
    sd = np.sqrt(np.diag(world.covariance))[3:]
    for i, s in enumerate(signals):
        better = theta[(sd < sd[i]) & (sd < np.radians(WELL_KNOWN_DEG))]
        if not len(better):
            continue
        azimuths = np.concatenate([theta[i : i + 1], better, better + np.pi / 2])
        trial = np.concatenate([world.parameters[:3], azimuths])
        points = upright.vanishing_points(trial)
        away = vanish.distance_deg(points[:1], s.loose)[0] > vanish.VERTICAL_DEG
        votes = vanish.vote(points[1:], s.loose[away], s.weights[away])
        votes[0] *= BORROWED
        parameters[3 + i] = azimuths[votes.argmax()]
    return parameters


def elevation(
    photo: Photo, facade: Facade, world: upright.Upright, rank: int, method: str
) -> Elevation | Rejection:
    """Straighten one front with the world's camera."""
    if world.support[rank + 1] < LEAST_LINES:
        return _rejected(photo, facade, "too few lines")
    points = quad.hull(facade.amodal)
    if len(points) < 3 or np.min(np.ptp(points, axis=0)) < LEAST_SIDE_PX:
        return _rejected(photo, facade, "facade too small")
    bounded = _bounded(photo, world.parameters, rank, facade, points)
    if bounded is None:
        return _rejected(photo, facade, "quad degenerate")
    aspect, corners = bounded
    if not ASPECTS[0] <= aspect <= ASPECTS[1]:
        return _rejected(photo, facade, "aspect implausible", f"{aspect:.3g}")
    shape = warp.size(corners, aspect)
    photo_from_elevation = warp.photo_from_elevation(corners, shape)
    image, alpha, rests_on = warp.elevate(
        photo.image,
        facade.alpha,
        facade.amodal,
        photo_from_elevation,
        shape,
        frame=photo.frame,
    )
    prior = camera.prior_focal_px(photo.frame)
    told = world.covariance[0, 0] < (TOLD * upright.LOG_FOCAL[1]) ** 2
    points_px = _to_photo(photo, upright.vanishing_points(world.parameters))
    return Elevation(
        facade=facade.index,
        image=image,
        alpha=alpha,
        evidence=rests_on,
        quad=corners,
        photo_from_elevation=photo_from_elevation,
        vanishing_points=points_px[[rank + 1, 0]],
        focal_px=world.focal * prior if told else None,
        aspect=aspect,
        vanishing_sd_deg=upright.directions_sd_deg(world, rank),
        focal_sd_px=world.focal * prior * float(np.sqrt(world.covariance[0, 0]))
        if told
        else None,
        aspect_sd=_aspect_sd(photo, world, rank, corners, aspect),
        method=method,
    )


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


def _bounded(
    photo: Photo, parameters: Parameters, rank: int, facade: Facade, points: Points
) -> tuple[float, Corners] | None:
    """Bound a front: its aspect ratio and its quad, or None if that degenerates."""
    plane = _plane(photo, parameters, rank, points)
    if np.linalg.cond(plane) > MOST_SKEWED:
        return None
    bounds = quad.bounding(plane, points)
    if bounds is None:
        return None
    bounds = quad.trimmed(facade.amodal, plane, bounds)
    corners = homography.apply(plane, quad.corners_of(bounds))
    focal = np.exp(parameters[0]) * camera.prior_focal_px(photo.frame)
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
    for i in (0, 1, 2, 3 + rank):
        moved = world.parameters.copy()
        moved[i] += 1e-4
        plane = _plane(photo, moved, rank, middles)
        flat = homography.apply(np.linalg.inv(plane), middles)
        width, height = flat[1, 0] - flat[3, 0], flat[2, 1] - flat[0, 1]
        slope[i] = (width / height - aspect) / 1e-4
    return float(np.sqrt(slope @ world.covariance @ slope))
