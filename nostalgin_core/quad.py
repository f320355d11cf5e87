"""Bound a front by the smallest quad whose sides run to its two vanishing points.

The paper draws rays from each vanishing point to the corners of the mask's bounding
box (section 3.3.3), which bounds the box and not the mask. Here the mask's own outline
is carried to the front's plane, where sides to vanishing points are upright and level,
and bounded there: that is the smallest quad of its kind.
"""

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core import homography
from nostalgin_core.arrays import Corners, Mask, Matrix3, Points

SPECK_SHARE = 0.02  # parts smaller than this share of the largest don't count
LEAST_DEPTH = 0.12  # a corner's nearness to the vanishing line, over the middle's


def hull(mask: Mask) -> Points:
    """Find the convex hull of a mask's pixels, corners of pixels included.

    A quad that bounds the hull bounds the mask, and a hull has few points.
    """
    found, _ = cv2.findContours(
        mask.astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE
    )
    areas = [cv2.contourArea(c) for c in found]
    if not areas or max(areas) <= 0:
        return np.empty((0, 2))
    parts = [
        c[:, 0]
        for c, area in zip(found, areas, strict=True)
        if area >= SPECK_SHARE * max(areas)
    ]
    return cv2.convexHull(np.vstack(parts))[:, 0].astype(np.float64)


def bounding(
    photo_from_plane: Matrix3, points: Points
) -> tuple[Float[np.ndarray, "4"], Corners] | None:
    """Bound points of the photo in a front's plane.

    Returns: x0, y0, x1, y1 in the plane and the quad in photo pixels; or None where a
    point or a corner lies at, near or beyond the plane's vanishing line, where the
    front would be infinitely long.
    """
    plane_from_photo = np.linalg.inv(photo_from_plane)
    lifted = np.column_stack([points, np.ones(len(points))]) @ plane_from_photo.T
    depth = 1 / np.where(lifted[:, 2] > 0, lifted[:, 2], np.inf)
    middle = float(np.median(depth))
    if middle <= 0 or not np.all((lifted[:, 2] > 0) & (depth < middle / LEAST_DEPTH)):
        return None
    flat = lifted[:, :2] / lifted[:, 2:]
    (x0, y0), (x1, y1) = flat.min(axis=0), flat.max(axis=0)
    corners = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
    nearness = np.column_stack([corners, np.ones(4)]) @ photo_from_plane[2]
    if np.any(nearness <= 0):
        return None
    return np.array([x0, y0, x1, y1]), homography.apply(photo_from_plane, corners)
