"""Find where a photo was taken from, as one of its fronts tells it.

A front that was straightened is a rectangle in space, and its quad that rectangle's
image under a known camera, so the camera stands where the quad's homography says
(Zhang, A flexible new technique for camera calibration, section 3.1). Nothing tells how
large the front is: lengths are in its widths, until it has found its lot.

Letters: `A` carries camera directions to photo pixels. Front axes are x to the right
along the front, y up, z out to the street, from its lower left corner; camera axes are
x right, y down, z into the scene.
"""

import numpy as np

from nostalgin_core import homography
from nostalgin_core.records import Box, Elevation, Standpoint
from nostalgin_core.rectify import camera, upright


def standpoint(view: Elevation, *, frame: Box, shape: tuple[int, int]) -> Standpoint:
    """Find the camera that took a photo of size `shape`, relative to one of its fronts.

    With the quad's four corners (0, 0), (1, 0), (1, 1/a) and (0, 1/a) in the front's
    plane, A^-1 H = s [r1 r2 t]: the front's axes and its corner, seen by the camera.
    """
    photo_from_camera = camera.matrix(focal_px(view, frame), frame)
    top = 1.0 / view.aspect
    front = np.array([[0.0, top], [1.0, top], [1.0, 0.0], [0.0, 0.0]])
    seen = np.linalg.solve(photo_from_camera, homography.between(front, view.quad))
    seen *= np.sign(seen[2, 2]) / np.linalg.norm(seen[:, 0])
    axes = np.column_stack([seen[:, 0], seen[:, 1], np.cross(seen[:, 0], seen[:, 1])])
    left, _, right = np.linalg.svd(axes)  # the nearest rotation
    front_from_camera = (left @ right).T
    position = -front_from_camera @ seen[:, 2]
    reach = float(np.hypot(*(position - [0.5, position[1], 0.0])[[0, 2]]))
    return Standpoint(
        size_px=(shape[1], shape[0]),
        photo_from_camera=photo_from_camera,
        focal_sd=focal_sd(view),
        position=(float(position[0]), float(position[1]), float(position[2])),
        position_sd=reach * float(np.hypot(focal_sd(view), turned_rad(view))),
        front_from_camera=front_from_camera,
        quad_px=view.quad,
        roof=top,
    )


def focal_px(view: Elevation, frame: Box) -> float:
    """Give the focal length that a front was straightened with, told or assumed.

    Its vertical vanishing point is A times a unit direction u: (f u_x + c_x u_z, f u_y
    + c_y u_z, u_z).
    """
    x, y, depth = view.vanishing_points[1]
    off = np.array([x, y]) - depth * camera.centre(frame)
    return float(np.hypot(*off) / np.sqrt(1.0 - depth**2))


def focal_sd(view: Elevation) -> float:
    """Give the focal length's standard deviation over itself; the prior's if untold."""
    if view.focal_px is None or view.focal_sd_px is None:
        return upright.LOG_FOCAL[1]
    return view.focal_sd_px / view.focal_px


def turned_rad(view: Elevation) -> float:
    """Give by how much the camera may be turned round the front, in radians."""
    return float(np.radians(view.vanishing_sd_deg[0]))
