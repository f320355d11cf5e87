"""A pinhole camera in the street, and what it makes of points and planes.

The world is east, north, up in metres. The camera's axes are right, down, forward.
A world point X lands at pixel x with

    x ~ K (R X + t),   K = [[f 0 cx] [0 f cy] [0 0 1]]

after Hartley and Zisserman, equation 6.8 with square pixels and no skew.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Homogeneous, Matrix3, Points

Vector = Float[np.ndarray, " 3"]
Places = Float[np.ndarray, "n 3"]  # east, north, up


@dataclass(frozen=True, slots=True, eq=False)
class Camera:
    """A pinhole camera: square pixels, no skew, no distortion."""

    focal_px: float
    principal_px: tuple[float, float]
    rotation: Matrix3  # camera from world
    translation_m: Vector  # camera from world

    @property
    def matrix(self) -> Matrix3:
        """The calibration matrix K."""
        cx, cy = self.principal_px
        f = self.focal_px
        return np.array([[f, 0.0, cx], [0.0, f, cy], [0.0, 0.0, 1.0]])

    @property
    def eye_m(self) -> Vector:
        """Where the camera stands: the point that it maps to zero."""
        return -self.rotation.T @ self.translation_m


def aim(
    eye_m: Vector,
    *,
    yaw_deg: float,
    tilt_deg: float,
    roll_deg: float,
    focal_px: float,
    principal_px: tuple[float, float],
) -> Camera:
    """Stand a camera at a place and point it.

    Yaw turns from north towards west (anticlockwise seen from above), tilt lifts the
    view, and roll turns the picture clockwise.
    """
    yaw, tilt, roll = np.deg2rad([yaw_deg, tilt_deg, roll_deg])
    flat = np.array([-np.sin(yaw), np.cos(yaw), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    forward = np.cos(tilt) * flat + np.sin(tilt) * up
    right = np.cross(flat, up)
    down = np.cross(forward, right)
    turn = np.array(
        [
            [np.cos(roll), -np.sin(roll), 0.0],
            [np.sin(roll), np.cos(roll), 0.0],
            [0.0, 0.0, 1.0],
        ]
    )
    rotation = turn @ np.stack([right, down, forward])
    return Camera(focal_px, principal_px, rotation, -rotation @ eye_m)


def see(camera: Camera, places_m: Places) -> Places:
    """Carry world points into the camera's axes; the third column is the depth."""
    return places_m @ camera.rotation.T + camera.translation_m


def project(camera: Camera, places_m: Places) -> Points:
    """Carry world points to pixels; meaningless for points behind the camera."""
    lifted = see(camera, places_m) @ camera.matrix.T
    return lifted[:, :2] / lifted[:, 2:]


def photo_from_plane(camera: Camera, origin_m: Vector, axes_m: Places) -> Matrix3:
    """Map plane coordinates to pixels.

    A point (a, b) of the plane stands at `origin + a axes[0] + b axes[1]`, so the
    homography is K [R u | R v | R o + t].
    """
    columns = [
        camera.rotation @ axes_m[0],
        camera.rotation @ axes_m[1],
        camera.rotation @ origin_m + camera.translation_m,
    ]
    return camera.matrix @ np.column_stack(columns)


def vanishing(camera: Camera, directions_m: Places) -> Homogeneous:
    """Give the points where lines of these directions meet, as unit 3-vectors."""
    points = directions_m @ (camera.matrix @ camera.rotation).T
    return points / np.linalg.norm(points, axis=1, keepdims=True)
