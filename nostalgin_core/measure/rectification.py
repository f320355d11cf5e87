"""Vanishing points, horizons and quads are compared with the truth.

All angles are in degrees. Directions have no sign: a vanishing point is the same for a
line seen to the left or to the right.
"""

from itertools import permutations

import numpy as np
from jaxtyping import Float

from nostalgin_core import homography
from nostalgin_core.arrays import Corners, Matrix3

UNMATCHED_DEG = 90.0  # the error of a direction that was not found
HORIZON_REACH = 0.25  # errors up to this share of the image's height count for the AUC


def direction_errors_deg(
    found: Float[np.ndarray, "m 3"] | None,
    true_directions: Float[np.ndarray, "k 3"],
    camera_matrix: Matrix3,
) -> Float[np.ndarray, " k"]:
    """Measure each true direction's angle to the found one that is matched to it.

    Found vanishing points become directions through the true camera. They are matched
    one to one so that the sum of angles is least; a true direction without a partner
    errs by 90 degrees.
    """
    errors = np.full(len(true_directions), UNMATCHED_DEG)
    if found is None or not len(found):
        return errors
    rays = np.linalg.solve(camera_matrix, found.T).T
    rays = rays / np.linalg.norm(rays, axis=1, keepdims=True)
    truth = true_directions / np.linalg.norm(true_directions, axis=1, keepdims=True)
    cosines = np.minimum(np.abs(truth @ rays.T), 1.0)
    angles = np.degrees(np.arccos(cosines))
    padded = np.full((len(truth), max(len(truth), len(rays))), UNMATCHED_DEG)
    padded[:, : len(rays)] = angles
    rows = np.arange(len(truth))
    best = min(
        permutations(range(padded.shape[1]), len(truth)),
        key=lambda columns: padded[rows, columns].sum(),
    )
    return padded[rows, best]


def horizon_error(
    found: Float[np.ndarray, "3"], true: Float[np.ndarray, "3"], shape: tuple[int, int]
) -> float:
    """Measure how far apart two horizons run within the image, over its height.

    Horizons are homogeneous lines (a, b, c): a x + b y + c = 0 in photo pixels. The
    distance is along y, the greater of the two at the left and the right edge.
    """
    h, w = shape
    x = np.array([-0.5, w - 0.5])
    ys = [-(line[0] * x + line[2]) / line[1] for line in (found, true)]
    return float(np.max(np.abs(ys[0] - ys[1])) / h)


def area_under_curve(
    errors: Float[np.ndarray, " n"], *, reach: float = HORIZON_REACH
) -> float:
    """Give the share, in percent, under the curve of errors' cumulative distribution.

    The curve runs from 0 to `reach`; an error of e then adds (reach - e) / reach.
    """
    return float(100 * np.mean(np.maximum(reach - errors, 0) / reach))


def worst_angle_deg(quad: Corners, photo_from_elevation: Matrix3) -> float:
    """Measure how far a true quad's corners are from 90 degrees once straightened.

    A quad that the homography tears apart, across its vanishing line, gives 90.
    """
    inverse = np.linalg.inv(photo_from_elevation)
    depth = np.column_stack([quad, np.ones(4)]) @ inverse[2]
    if np.any(np.abs(depth) < 1e-12) or np.ptp(np.sign(depth)) > 0:
        return 90.0
    flat = homography.apply(inverse, quad)
    side = np.roll(flat, -1, axis=0) - flat
    side = side / np.linalg.norm(side, axis=1, keepdims=True)
    cosines = np.abs(np.sum(side * np.roll(side, 1, axis=0), axis=1))
    return float(np.degrees(np.arcsin(np.minimum(cosines, 1.0))).max())


def corner_error_px(found: Corners, true: Corners) -> float:
    """Measure the mean distance of a quad's corners from the true ones."""
    return float(np.linalg.norm(found - true, axis=1).mean())


def width_px(quad: Corners) -> float:
    """Measure how wide a quad is: the mean of its upper and its lower side."""
    upper, lower = quad[1] - quad[0], quad[2] - quad[3]
    return float((np.linalg.norm(upper) + np.linalg.norm(lower)) / 2)


def angle_deg(
    one: Float[np.ndarray, "3"], other: Float[np.ndarray, "3"], camera_matrix: Matrix3
) -> float:
    """Measure the angle between the directions of two vanishing points.

    The sine is the norm of the cross product of unit rays, which is exact near zero,
    where the cosine is flat.
    """
    rays = np.linalg.solve(camera_matrix, np.column_stack([one, other]))
    a, b = (rays / np.linalg.norm(rays, axis=0)).T
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), abs(a @ b))))


def bounded_aspect(found: Corners, true: Corners, true_aspect: float) -> float:
    """Measure the true width over height of what a found quad bounds of a front.

    The found corners are carried to the front's plane by the true homography; width
    and height join the middles of opposite sides. Where the photo's edge cuts a front,
    this is what its aspect ratio has to be compared with.
    """
    width, height = true_aspect, 1.0
    rectangle = np.array([[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]])
    flat = homography.apply(homography.between(true, rectangle), found)
    middles = (flat + np.roll(flat, -1, axis=0)) / 2
    across, down = middles[1] - middles[3], middles[2] - middles[0]
    return float(np.linalg.norm(across) / np.linalg.norm(down))


def view_deg(quad: Corners, camera_matrix: Matrix3) -> float:
    """Measure at what angle a front is seen: 0 straight on, near 90 along it.

    It is the angle between the front's normal and the ray to the quad's middle, where
    its diagonals meet. The quad is a rectangle's image.
    """
    unit = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    plane = np.linalg.solve(camera_matrix, homography.between(unit, quad))
    normal = np.cross(plane[:, 0], plane[:, 1])
    ray = plane @ [0.5, 0.5, 1.0]
    cosine = abs(normal @ ray) / (np.linalg.norm(normal) * np.linalg.norm(ray))
    return float(np.degrees(np.arccos(min(1.0, cosine))))
