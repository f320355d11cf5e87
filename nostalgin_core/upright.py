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
from jaxtyping import Float, Int

from nostalgin_core.arrays import Homogeneous, Lines

# Priors, as (mean, standard deviation).
LOG_FOCAL = (0.0, 0.2)
ROLL_RAD = (0.0, 0.05)  # surveyors level their tripods
TILT_RAD = (0.1, 0.25)
END_SD_PX = 0.35  # of a line's end, across the line
BENT_SD_DEG = 0.35  # how far from parallel real cornices and sills are
GATES_DEG = (3.0, 2.0, 1.5, 1.5)  # a line beyond has no say, round by round


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
    front: Int[np.ndarray, " n"],
    omega: Float[np.ndarray, " n"],
    length_px: Float[np.ndarray, " n"],
    *,
    focal_sd: float = LOG_FOCAL[1],
) -> Upright:
    """Fit the parameters to all lines together, robustly.

    A line belongs to the vertical or to its own front's horizontal, whichever is
    nearer, or beyond the gate to neither; that is decided anew each round, and the gate
    narrows. Within a round, Gauss-Newton steps with Cauchy's weights. A line's
    direction is known to END_SD over half its length, plus BENT_SD.
    """
    sd = np.hypot(END_SD_PX / np.maximum(length_px / 2, 1.0), np.radians(BENT_SD_DEG))
    prior_mean = np.array([LOG_FOCAL[0], ROLL_RAD[0], TILT_RAD[0]])
    prior_sd = np.array([focal_sd, ROLL_RAD[1], TILT_RAD[1]])
    p = parameters.copy()
    fronts = len(p) - 3
    zero = np.zeros(len(lines), np.intp)
    for gate in GATES_DEG:
        up, across = sines(p, lines, zero), sines(p, lines, front + 1)
        axis = np.where(np.abs(up) < np.abs(across), 0, front + 1)
        near = np.minimum(np.abs(up), np.abs(across)) < np.sin(np.radians(gate))
        chosen, axis_in = lines[near], axis[near]
        sd_in, omega_in = sd[near], omega[near]
        for _ in range(4):
            r = sines(p, chosen, axis_in)
            jacobian = np.empty((len(r), len(p)))
            for i in range(len(p)):
                step = np.zeros(len(p))
                step[i] = 1e-6
                jacobian[:, i] = (sines(p + step, chosen, axis_in) - r) / 1e-6
            weight = omega_in / sd_in**2 / (1 + (r / (2 * sd_in)) ** 2)
            normal = jacobian.T @ (jacobian * weight[:, None])
            gradient = jacobian.T @ (weight * r)
            normal[[0, 1, 2], [0, 1, 2]] += 1 / prior_sd**2
            gradient[:3] += (p[:3] - prior_mean) / prior_sd**2
            normal[range(3, 3 + fronts), range(3, 3 + fronts)] += 1e-3
            p = p - np.clip(np.linalg.solve(normal, gradient), -0.2, 0.2)
    support = np.bincount(axis_in, omega_in, minlength=fronts + 1)
    return Upright(p, np.linalg.inv(normal), support)


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
