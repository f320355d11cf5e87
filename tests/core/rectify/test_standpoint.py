from dataclasses import replace

import numpy as np
import pytest

from nostalgin_core import homography, rectify
from nostalgin_core.records import Elevation, Standpoint
from nostalgin_core.rectify import camera, upright
from tests.painted_front import SHAPE, Painted, photograph


def truth(plane: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Tell where the painter stood and how he turned, in a front's widths and axes."""
    across, down, top = plane.T
    width = np.linalg.norm(across)
    right, up = across / width, -down / np.linalg.norm(down)
    front_from_camera = np.vstack([right, up, np.cross(right, up)])
    return -front_from_camera @ (top + down) / width, front_from_camera


def known(painted: Painted, rank: int) -> Elevation:
    """Give what a rectifier knows that knows all."""
    plane, frame = painted.planes[rank], painted.photo.frame
    directions = [plane[:, 0], -plane[:, 1]]
    rays = np.array([one / np.linalg.norm(one) for one in directions])
    found = rectify.rectify(painted.photo, painted.matted)[rank]
    assert isinstance(found, Elevation)
    return replace(
        found,
        quad=painted.quads[rank],
        vanishing_points=rays @ camera.matrix(painted.focal_px, frame).T,
        aspect=painted.aspects[rank],
    )


def stood(painted: Painted, view: Elevation) -> Standpoint:
    return rectify.standpoint(view, frame=painted.photo.frame, shape=SHAPE)


@pytest.mark.parametrize("rank", [0, 1])
def test_what_is_known_exactly_leads_exactly_to_the_camera(rank: int) -> None:
    painted = photograph(focal=640.0, roll_deg=-2.0, tilt_deg=9.0)
    found = stood(painted, known(painted, rank))
    position, front_from_camera = truth(painted.planes[rank])
    np.testing.assert_allclose(found.position, position, atol=1e-6)
    np.testing.assert_allclose(found.front_from_camera, front_from_camera, atol=1e-6)
    assert found.photo_from_camera[0, 0] == pytest.approx(640.0)


@pytest.mark.parametrize("seed", range(4))
def test_the_front_as_the_camera_sees_it_is_the_quad(seed: int) -> None:
    painted = photograph(tilt_deg=4.0 * seed, azimuths_deg=(-20.0 - 10 * seed, 62.0))
    for view in rectify.rectify(painted.photo, painted.matted):
        assert isinstance(view, Elevation)
        one = stood(painted, view)
        corners = np.array(
            [[0, one.roof, 0], [1, one.roof, 0], [1, 0, 0], [0, 0, 0]], float
        )
        rays = (corners - one.position) @ one.front_from_camera
        pixels = rays @ one.photo_from_camera.T
        np.testing.assert_allclose(pixels[:, :2] / pixels[:, 2:], view.quad, atol=1e-3)


def test_a_rotation_turns_and_does_not_mirror() -> None:
    painted = photograph()
    turn = stood(painted, known(painted, 0)).front_from_camera
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(turn) == pytest.approx(1.0)


def test_the_stated_error_holds_what_photographs_of_painted_fronts_miss_by() -> None:
    rng = np.random.default_rng(5)
    within = []
    for seed in range(16):
        turn = float(rng.uniform(-60, -20))
        painted = photograph(
            focal=float(rng.uniform(560, 820)),
            roll_deg=float(rng.normal(0, 1.5)),
            tilt_deg=float(rng.uniform(3, 16)),
            azimuths_deg=(turn, turn + 90),
            seed=seed,
        )
        for rank, view in enumerate(rectify.rectify(painted.photo, painted.matted)):
            if isinstance(view, Elevation):
                one = stood(painted, view)
                off = np.subtract(one.position, truth(painted.planes[rank])[0])
                within.append(np.hypot(off[0], off[2]) / one.position_sd)
    assert len(within) >= 24
    assert np.mean(np.array(within) < 1.96) >= 0.9


def test_a_view_that_tells_no_focal_length_is_as_unsure_as_the_prior() -> None:
    painted = photograph()
    untold = replace(known(painted, 0), focal_px=None, focal_sd_px=None)
    assert stood(painted, untold).focal_sd == upright.LOG_FOCAL[1]


def test_a_front_twice_as_far_is_seen_half_as_large() -> None:
    painted = photograph(azimuths_deg=(0.0,), aspects=(0.8,), tilt_deg=0, roll_deg=0)
    view = known(painted, 0)
    middle = camera.centre(painted.photo.frame)
    half = homography.apply(
        np.array([[0.5, 0, middle[0] / 2], [0, 0.5, middle[1] / 2], [0, 0, 1.0]]),
        view.quad,
    )
    near, far = stood(painted, view), stood(painted, replace(view, quad=half))
    assert far.position[2] == pytest.approx(2 * near.position[2])
