"""Bound a front by the smallest quad whose sides run to its two vanishing points.

The paper draws rays from each vanishing point to the corners of the mask's bounding
box (section 3.3.3), which bounds the box and not the mask. Here the mask's own outline
is carried to the front's plane, where sides to vanishing points are upright and level,
and bounded there: that is the smallest quad of its kind.
"""

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Alpha, Corners, Mask, Matrix3, Points

SPECK_SHARE = 0.02  # parts smaller than this share of the largest don't count
LEAST_SHARE = 0.25  # of the fullest row: emptier ones at a side are its raggedness
MOST_TRIMMED = 0.12  # of the front's extent, on each side
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
) -> Float[np.ndarray, "4"] | None:
    """Bound points of the photo in a front's plane.

    Returns: x0, y0, x1, y1 in the plane, or None where a point or a corner lies at,
    near or beyond the plane's vanishing line, where the front would be infinitely long.
    """
    plane_from_photo = np.linalg.inv(photo_from_plane)
    lifted = np.column_stack([points, np.ones(len(points))]) @ plane_from_photo.T
    depth = 1 / np.where(lifted[:, 2] > 0, lifted[:, 2], np.inf)
    middle = float(np.median(depth))
    if middle <= 0 or not np.all((lifted[:, 2] > 0) & (depth < middle / LEAST_DEPTH)):
        return None
    flat = lifted[:, :2] / lifted[:, 2:]
    (x0, y0), (x1, y1) = flat.min(axis=0), flat.max(axis=0)
    corners = corners_of(np.array([x0, y0, x1, y1]))
    nearness = np.column_stack([corners, np.ones(4)]) @ photo_from_plane[2]
    if np.any(nearness <= 0):
        return None
    return np.array([x0, y0, x1, y1])


def corners_of(bounds: Float[np.ndarray, "4"]) -> Corners:
    """List a rectangle's corners, clockwise from the top left."""
    x0, y0, x1, y1 = bounds
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])


def trimmed(
    mask: Mask,
    photo_from_plane: Matrix3,
    bounds: Float[np.ndarray, "4"],
    *,
    least_share: float = LEAST_SHARE,
    cells: int = 96,
) -> Float[np.ndarray, "4"]:
    """Move a front's bounds inwards past what only a ragged outline reaches.

    A network's outline strays outwards somewhere on each side, and the smallest quad
    round it would be too large on all four. The mask is resampled in the plane, and
    each side moves in while its row or column is less than `least_share` as full as
    the fullest of them, but not by more than `MOST_TRIMMED` of the extent: a tower's
    top, narrower than its foot, stays.
    """
    x0, y0, x1, y1 = bounds
    step = np.array([(x1 - x0) / cells, (y1 - y0) / cells])
    grid = resampled(mask, photo_from_plane, bounds, cells)
    x_from, x_to = _filled(grid.sum(axis=0), least_share)
    y_from, y_to = _filled(grid.sum(axis=1), least_share)
    return np.array(
        [
            x0 + x_from * step[0],
            y0 + y_from * step[1],
            x0 + x_to * step[0],
            y0 + y_to * step[1],
        ]
    )


def resampled(
    mask: Mask | Alpha,
    photo_from_plane: Matrix3,
    bounds: Float[np.ndarray, "4"],
    cells: int,
) -> Float[np.ndarray, "c c"]:
    """Resample a mask inside bounds of a front's plane, in so many rows and columns."""
    x0, y0, x1, y1 = bounds
    step = np.array([(x1 - x0) / cells, (y1 - y0) / cells])
    plane_from_cell = np.array(
        [
            [step[0], 0.0, x0 + step[0] / 2],
            [0.0, step[1], y0 + step[1] / 2],
            [0.0, 0.0, 1.0],
        ]
    )
    return cv2.warpPerspective(
        mask.astype(np.float32),
        photo_from_plane @ plane_from_cell,
        (cells, cells),
        flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
        borderMode=cv2.BORDER_REPLICATE,
    )


def _filled(profile: Float[np.ndarray, " c"], least_share: float) -> tuple[int, int]:
    """Give the cells between which a profile is full enough."""
    most = round(MOST_TRIMMED * len(profile))
    full = np.flatnonzero(profile >= least_share * profile.max())
    return min(int(full[0]), most), max(int(full[-1]) + 1, len(profile) - most)
