"""Fit one camera and one upright world to the lines of all fronts of a photo.

Fronts of one photo share the camera and the direction that is up, and their horizontal
directions are at right angles to it. So a photo with F fronts has 3 + F unknowns, not
4 F: the focal length, the camera's roll and tilt, and for each front the azimuth of its
horizontal. A front with few lines borrows from its neighbours.

Letters: `f` the focal length over the prior's, `rho` the roll and `tau` the tilt of the
camera in radians, `theta` a front's azimuth. Camera axes are x right, y down, z into
the scene, and coordinates are centred on the principal point and divided by the prior's
focal length (`vanish.to_unit`).
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from nostalgin_core.arrays import Homogeneous, Lines

# Priors, as (mean, standard deviation).
LOG_FOCAL = (0.0, 0.2)
ROLL_RAD = (0.0, 0.05)  # surveyors level their tripods
TILT_RAD = (0.1, 0.25)
END_SD_PX = 0.35  # of a line's end, across the line
BENT_SD_DEG = 0.35  # how far from parallel real cornices and sills are
STEPS = 3  # Gauss-Newton steps a round
DELTA = 1e-6  # for differences; everything here is of the order of one
TIE_DEG = 4.0  # fronts this near to parallel or square are taken to be so,
TIE_SD_DEG = 1.0  # to within this
TOGETHER = 4.0  # lines to one independent measurement
LEAST_SPREAD = 0.01  # the variance of lines over the assumed: no edge is perfect
LEAST_CERTAIN = 1e-3  # 1 / rad^2 of an azimuth of which nothing is known
GATES_DEG = (5.0, 3.0, 2.0, 1.5)  # a line beyond has no say, round by round


@dataclass(frozen=True, slots=True, eq=False)
class Upright:
    """The camera, the way up, and each front's horizontal direction."""

    parameters: Float[np.ndarray, " p"]  # log f, rho, tau, theta of each front
    covariance: Float[np.ndarray, "p p"]
    support: Float[np.ndarray, " k"]  # weight of lines: the vertical, then each front

    @property
    def focal(self) -> float:
        """Give the focal length, over the prior's."""
        return float(np.exp(self.parameters[0]))


def axes(
    parameters: Float[np.ndarray, " p"],
) -> Float[np.ndarray, "k 3"]:
    """Give the direction up, then each front's horizontal, in camera coordinates.

    Up is (sin rho cos tau, -cos rho cos tau, sin tau): a camera that looks upwards has
    tau > 0 and sees the verticals meet above. The horizontal of theta = 0 runs to the
    right across the view, and of 90 degrees away from the camera.
    """
    rho, tau = parameters[1:3]
    theta = parameters[3:]
    up = np.array([np.sin(rho) * np.cos(tau), -np.cos(rho) * np.cos(tau), np.sin(tau)])
    right = np.array([np.cos(rho), np.sin(rho), 0.0])
    ahead = np.cross(right, up)
    ahead = ahead if ahead[2] > 0 else -ahead
    across = np.cos(theta)[:, None] * right + np.sin(theta)[:, None] * ahead
    return np.vstack([up, across])


def vanishing_points(parameters: Float[np.ndarray, " p"]) -> Homogeneous:
    """Project the axes: the vertical vanishing point, then each front's, in units."""
    focal = np.exp(parameters[0])
    return axes(parameters) * [focal, focal, 1.0]


def start(vertical: Float[np.ndarray, "3"], fronts: Homogeneous) -> np.ndarray:
    """Turn vanishing points into parameters, with the prior's focal length."""
    up = vertical / np.linalg.norm(vertical)
    up = up if up[1] < 0 else -up
    rho, tau = np.arctan2(up[0], -up[1]), np.arcsin(np.clip(up[2], -1, 1))
    frame = axes(np.array([0.0, rho, tau, 0.0, np.pi / 2]))
    theta = np.arctan2(fronts @ frame[2], fronts @ frame[1])
    return np.concatenate([[0.0, rho, tau], theta])


def azimuths(
    parameters: Float[np.ndarray, " p"], lines: Lines
) -> Float[np.ndarray, " n"]:
    """Give the azimuth that each line has if it is level.

    A line and the camera span a plane with normal (f a, f b, c), where a x + b y + c =
    0 is the line; a level direction in it is square to the normal and to up.
    """
    focal = np.exp(parameters[0])
    one = np.ones((len(lines), 1))
    normals = np.cross(np.hstack([lines[:, :2], one]), np.hstack([lines[:, 2:], one]))
    up, right, ahead = axes(np.array([*parameters[:3], 0.0, np.pi / 2]))
    level = np.cross(normals * [focal, focal, 1.0], up)
    return np.arctan2(level @ ahead, level @ right)


def sines(
    parameters: Float[np.ndarray, " p"], lines: Lines, axis: Int[np.ndarray, " n"]
) -> Float[np.ndarray, " n"]:
    """Give the signed sine of the angle between each line and the ray to its point."""
    point = vanishing_points(parameters)[axis]
    middle = (lines[:, :2] + lines[:, 2:]) / 2
    along = lines[:, 2:] - lines[:, :2]
    ray = point[:, :2] - middle * point[:, 2:]
    cross = ray[:, 0] * along[:, 1] - ray[:, 1] * along[:, 0]
    norm = np.hypot(*ray.T) * np.hypot(*along.T)
    return cross / np.maximum(norm, 1e-12)


def fit(
    parameters: Float[np.ndarray, " p"],
    lines: Lines,
    open_to: Bool[np.ndarray, "n k"],
    omega: Float[np.ndarray, " n"],
    length_px: Float[np.ndarray, " n"],
    *,
    focal_sd: float = LOG_FOCAL[1],
) -> Upright:
    """Fit the parameters to all lines together, robustly.

    A line belongs to that axis, of those it is open to, which it misses least, or
    beyond the gate to none; that is decided anew each round, and the gate narrows.
    Within a round, Gauss-Newton steps with Cauchy's weights. A line's direction is
    known to END_SD over half its length, plus BENT_SD.

    The covariance is the inverse of the normal matrix, with the lines' part scaled by
    how far they really scatter (`spread`). Lines err together (one sill, one cornice),
    so only every `TOGETHER`th counts as independent.
    """
    sd = np.hypot(END_SD_PX / np.maximum(length_px / 2, 1.0), np.radians(BENT_SD_DEG))
    p = parameters.copy()
    for gate in GATES_DEG:
        axis, missed = nearest(p, lines, open_to)
        near = missed < np.sin(np.radians(gate))
        chosen = lines[near], axis[near], sd[near], omega[near]
        for _ in range(STEPS):
            told, gradient = _told(p, *chosen)
            assumed, pull = _assumed(p, focal_sd)
            step = np.linalg.solve(told + assumed, gradient + pull)
            p = p - np.clip(step, -0.2, 0.2)
    support = np.bincount(axis[near], omega[near], minlength=len(p) - 2)
    _, missed = nearest(p, lines, open_to)
    scatter = spread(missed, sd, omega)
    covariance = np.linalg.inv(told / (TOGETHER * scatter) + assumed)
    return Upright(p, covariance, support.astype(np.float64))


def nearest(
    parameters: Float[np.ndarray, " p"], lines: Lines, open_to: Bool[np.ndarray, "n k"]
) -> tuple[Int[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    """Give the axis that each line misses least, of those it is open to, and the sine.

    A line that is open to none misses by infinity.
    """
    missed = np.abs(sines_to_all(parameters, lines))
    missed[~open_to] = np.inf
    return missed.argmin(axis=1), missed.min(axis=1)


def _told(
    parameters: Float[np.ndarray, " p"],
    lines: Lines,
    axis: Int[np.ndarray, " n"],
    sd: Float[np.ndarray, " n"],
    omega: Float[np.ndarray, " n"],
) -> tuple[Float[np.ndarray, "p p"], Float[np.ndarray, " p"]]:
    """Sum up what lines tell: their normal matrix and the gradient of their misfit."""
    r = sines(parameters, lines, axis)
    jacobian = slopes(parameters, lines, axis, r)
    weight = omega / sd**2 / (1 + (r / (2 * sd)) ** 2)
    return jacobian.T @ (jacobian * weight[:, None]), jacobian.T @ (weight * r)


def _assumed(
    parameters: Float[np.ndarray, " p"], focal_sd: float
) -> tuple[Float[np.ndarray, "p p"], Float[np.ndarray, " p"]]:
    """Sum up what is known before: the priors' normal matrix and gradient.

    Fronts within `TIE_DEG` of parallel or of a right angle are pulled there by a weak
    prior: streets are straight and most corners square, and where they aren't, the
    fronts' own lines say so.
    """
    mean = np.array([LOG_FOCAL[0], ROLL_RAD[0], TILT_RAD[0]])
    certain = np.array([focal_sd, ROLL_RAD[1], TILT_RAD[1]]) ** -2.0
    ties, pull = _ties(parameters[3:])
    normal = np.diag([*certain, *np.full(len(pull), LEAST_CERTAIN)])
    normal[3:, 3:] += ties
    return normal, np.concatenate([(parameters[:3] - mean) * certain, pull])


def slopes(
    parameters: Float[np.ndarray, " p"],
    lines: Lines,
    axis: Int[np.ndarray, " n"],
    here: Float[np.ndarray, " n"],
) -> Float[np.ndarray, "n p"]:
    """Differentiate `sines` by the parameters, numerically.

    An azimuth moves its own front's lines alone, so all azimuths take one step.
    """
    jacobian = np.zeros((len(here), len(parameters)))
    for i in range(3):
        step = np.zeros(len(parameters))
        step[i] = DELTA
        jacobian[:, i] = (sines(parameters + step, lines, axis) - here) / DELTA
    step = np.zeros(len(parameters))
    step[3:] = DELTA
    turned = (sines(parameters + step, lines, axis) - here) / DELTA
    level = np.flatnonzero(axis > 0)
    jacobian[level, axis[level] + 2] = turned[level]
    return jacobian


def sines_to_all(
    parameters: Float[np.ndarray, " p"], lines: Lines
) -> Float[np.ndarray, "n k"]:
    """Give `sines` of every line to every axis."""
    count = len(parameters) - 2
    each = [
        sines(parameters, lines, np.full(len(lines), axis)) for axis in range(count)
    ]
    return np.column_stack(each)


def spread(
    missed: Float[np.ndarray, " n"],
    sd: Float[np.ndarray, " n"],
    omega: Float[np.ndarray, " n"],
) -> float:
    """Measure the lines' variance over the assumed one, by their median miss.

    A normal variable's size has the median 0.6745 sd. All lines within the first gate
    count: those within the last are near by choice and would scatter little in any
    photo. Clean edges scatter less than assumed, a blurred photo's more.
    """
    near = missed < np.sin(np.radians(GATES_DEG[0]))
    if omega[near].sum() < 1:
        return 1.0
    size = missed[near] / sd[near]
    order = np.argsort(size, kind="stable")
    total = np.cumsum(omega[near][order])
    median = size[order][np.searchsorted(total, total[-1] / 2)]
    return max(float(median / 0.6745) ** 2, LEAST_SPREAD)


def _ties(
    theta: Float[np.ndarray, " f"],
) -> tuple[Float[np.ndarray, "f f"], Float[np.ndarray, " f"]]:
    """Pull fronts that are nearly parallel or square to one another all the way."""
    fronts = len(theta)
    normal, gradient = np.zeros((fronts, fronts)), np.zeros(fronts)
    for i in range(fronts):
        for j in range(i):
            off = (theta[i] - theta[j] + np.pi / 4) % (np.pi / 2) - np.pi / 4
            if abs(off) < np.radians(TIE_DEG):
                weight = 1 / np.radians(TIE_SD_DEG) ** 2 / fronts
                normal[[i, j], [i, j]] += weight
                normal[[i, j], [j, i]] -= weight
                gradient[i] += weight * off
                gradient[j] -= weight * off
    return normal, gradient


def directions_sd_deg(world: Upright, rank: int) -> tuple[float, float]:
    """Estimate how far a front's two vanishing points may be off, in degrees.

    The covariance is carried to the points as seen on the unit sphere round the
    estimated camera; the figure is the root of its trace, so of both directions.
    """
    focal = world.focal
    sds = []
    for axis in (rank + 1, 0):

        def on_sphere(p: Float[np.ndarray, " p"], axis: int = axis) -> np.ndarray:
            ray = vanishing_points(p)[axis] / [focal, focal, 1.0]
            return ray / np.linalg.norm(ray)

        here = on_sphere(world.parameters)
        steps = np.eye(len(world.parameters)) * 1e-6
        jacobian = np.column_stack(
            [(on_sphere(world.parameters + step) - here) / 1e-6 for step in steps]
        )
        spread = jacobian @ world.covariance @ jacobian.T
        sds.append(float(np.degrees(np.sqrt(np.trace(spread)))))
    return sds[0], sds[1]
