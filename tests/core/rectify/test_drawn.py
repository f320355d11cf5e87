"""A quad that somebody drew gives the elevation that a camera like that would give."""

import numpy as np
import pytest

from nostalgin_core import homography, rectify
from nostalgin_core.records import (
    Box,
    Elevation,
    Facade,
    Matted,
    Photo,
    Rejection,
)
from nostalgin_core.rectify import camera

FRAME = Box(0, 0, 480, 640)


def seen(width: float, height: float, yaw_deg: float) -> np.ndarray:
    """Photograph a rectangle from the street, with the prior's focal length."""
    yaw = np.radians(yaw_deg)
    across = np.array([np.cos(yaw), 0.0, np.sin(yaw)])
    flat = np.array(
        [
            x * width * across + np.array([0.0, y * height, 3.0])
            for x, y in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))
        ]
    )
    a = camera.matrix(camera.prior_focal_px(FRAME), FRAME)
    points = flat @ a.T
    return points[:, :2] / points[:, 2:]


def photo_of(corners: np.ndarray) -> tuple[Photo, Matted]:
    image = np.full((640, 480), 128, np.uint8)
    photo = Photo("painted", image, FRAME)
    ys, xs = np.mgrid[:640, :480]
    lower, upper = corners.min(axis=0), corners.max(axis=0)
    mask = (xs >= lower[0]) & (xs <= upper[0]) & (ys >= lower[1]) & (ys <= upper[1])
    front = Facade(0, 0.9, True, 0.9, mask, mask, mask.astype(np.float32))  # noqa: FBT003
    return photo, Matted((front,), ())


def drawn(corners: np.ndarray) -> Elevation:
    photo, matted = photo_of(corners)
    views = [Rejection("painted", "rectify", "too few lines", facade=0)]
    (made,) = rectify.drawn(photo, matted, views, corners, sd_px=1.0)
    assert isinstance(made, Elevation)
    return made


@pytest.mark.parametrize("yaw_deg", [0.0, 12.0, -25.0, 40.0])
@pytest.mark.parametrize("height", [0.8, 1.4])
def test_the_proportions_are_those_of_the_rectangle(
    yaw_deg: float, height: float
) -> None:
    made = drawn(seen(1.0, height, yaw_deg))
    assert made.aspect == pytest.approx(1 / height, rel=1e-6)
    assert made.method == "drawn by hand"
    assert np.array_equal(made.quad, seen(1.0, height, yaw_deg))


@pytest.mark.parametrize("yaw_deg", [12.0, -25.0, 40.0])
def test_the_level_vanishing_point_is_where_the_front_leads(yaw_deg: float) -> None:
    made = drawn(seen(1.0, 1.2, yaw_deg))
    yaw = np.radians(yaw_deg)
    focal = camera.prior_focal_px(FRAME)
    x, y, depth = made.vanishing_points[0]
    middle = camera.centre(FRAME)
    assert x / depth - middle[0] == pytest.approx(focal / np.tan(yaw), rel=1e-6)
    assert y / depth == pytest.approx(middle[1], abs=1e-3)


def test_the_camera_stands_where_it_stood() -> None:
    corners = seen(1.0, 1.2, 25.0)
    made = drawn(corners)
    stood = rectify.standpoint(made, frame=FRAME, shape=(640, 480))
    assert np.hypot(stood.position[0] - 0.5, stood.position[2]) == pytest.approx(3.0)


def test_a_slip_of_the_hand_and_the_focal_length_make_it_unsure() -> None:
    head_on, oblique = drawn(seen(1.0, 1.2, 0.0)), drawn(seen(1.0, 1.2, 40.0))
    assert 0 < head_on.aspect_sd / head_on.aspect < 0.02
    assert oblique.aspect_sd / oblique.aspect > head_on.aspect_sd / head_on.aspect
    assert min(*head_on.vanishing_sd_deg, *oblique.vanishing_sd_deg) > 0


def test_only_the_front_under_the_quad_is_straightened_anew() -> None:
    corners = seen(0.5, 1.2, 0.0)
    photo, matted = photo_of(corners)
    far = np.zeros((640, 480), bool)
    far[:, :40] = True
    other = Facade(0, 0.9, True, 0.9, far, far, far.astype(np.float32))  # noqa: FBT003
    both = Matted((other, *matted.facades), ())
    views = [Rejection("painted", "rectify", "r", facade=n) for n in (0, 1)]
    made = rectify.drawn(photo, both, views, corners, sd_px=1.0)
    assert made[0] is views[0]
    assert isinstance(made[1], Elevation)


def test_the_elevation_s_corners_are_the_quad_s() -> None:
    corners = seen(1.0, 1.2, 20.0)
    made = drawn(corners)
    h, w = made.image.shape
    edges = np.array([[0, 0], [w, 0], [w, h], [0, h]], np.float64) - 0.5
    there = homography.apply(made.photo_from_elevation, edges)
    assert np.allclose(there, corners, atol=1e-6)
