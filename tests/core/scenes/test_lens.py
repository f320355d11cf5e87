import numpy as np
import pytest

from nostalgin_core import homography
from nostalgin_core.scenes import lens

VIEWS = [(0.0, 0.0, 0.0), (35.0, 9.0, 1.0), (-140.0, 17.0, -2.0)]


def stand(yaw: float, tilt: float, roll: float) -> lens.Camera:
    return lens.aim(
        np.array([3.0, -2.0, 1.5]),
        yaw_deg=yaw,
        tilt_deg=tilt,
        roll_deg=roll,
        focal_px=670.0,
        principal_px=(279.5, 419.5),
    )


def ahead(camera: lens.Camera, n: int = 6) -> np.ndarray:
    rng = np.random.default_rng(1)
    local = rng.uniform([-3, -3, 8], [3, 3, 20], (n, 3))
    return (local - camera.translation_m) @ camera.rotation


@pytest.mark.parametrize("view", VIEWS)
def test_the_rotation_is_a_rotation(view: tuple[float, float, float]) -> None:
    rotation = stand(*view).rotation
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1.0)


@pytest.mark.parametrize("view", VIEWS)
def test_the_eye_is_where_the_camera_was_stood(
    view: tuple[float, float, float],
) -> None:
    np.testing.assert_allclose(stand(*view).eye_m, [3.0, -2.0, 1.5], atol=1e-12)


def test_a_level_camera_looks_north_and_sees_up_as_up() -> None:
    camera = stand(0.0, 0.0, 0.0)
    pixels = lens.project(
        camera, np.array([[3.0, 8.0, 1.5], [4.0, 8.0, 1.5], [3.0, 8.0, 2.5]])
    )
    np.testing.assert_allclose(pixels[0], [279.5, 419.5], atol=1e-9)
    np.testing.assert_allclose(pixels[1] - pixels[0], [67.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(pixels[2] - pixels[0], [0.0, -67.0], atol=1e-9)


@pytest.mark.parametrize("view", VIEWS)
def test_the_planes_homography_agrees_with_the_projection(
    view: tuple[float, float, float],
) -> None:
    camera = stand(*view)
    corner, u, v = ahead(camera, 3)
    axes = np.stack([u - corner, v - corner])
    plane = np.random.default_rng(2).uniform(0, 1, (20, 2))
    photo_from_plane = lens.photo_from_plane(camera, corner, axes)
    np.testing.assert_allclose(
        homography.apply(photo_from_plane, plane),
        lens.project(camera, corner + plane @ axes),
        atol=1e-8,
    )


@pytest.mark.parametrize("view", VIEWS)
def test_far_along_a_direction_lies_its_vanishing_point(
    view: tuple[float, float, float],
) -> None:
    camera = stand(*view)
    direction = camera.rotation[2] + 0.3 * camera.rotation[0]
    point = lens.vanishing(camera, direction[None])[0]
    far = lens.project(camera, (camera.eye_m + 1e7 * direction)[None] + 5.0)[0]
    np.testing.assert_allclose(point[:2] / point[2], far, atol=1e-2)
