import numpy as np
import pytest

from nostalgin_core import homography
from nostalgin_core.measure import rectification

CAMERA = np.array([[700.0, 0.0, 320.0], [0.0, 700.0, 240.0], [0.0, 0.0, 1.0]])
SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def test_true_points_err_by_nothing_in_any_order_and_sign() -> None:
    points = np.eye(3) @ CAMERA.T
    shuffled = points[[2, 0, 1]] * [[-1.0], [3.0], [1.0]]
    errors = rectification.direction_errors_deg(shuffled, np.eye(3), CAMERA)
    np.testing.assert_allclose(errors, 0, atol=1e-6)


def test_a_turned_direction_errs_by_its_turn() -> None:
    turn = np.radians(7)
    ray = np.array([[np.cos(turn), 0.0, np.sin(turn)]])
    errors = rectification.direction_errors_deg(
        ray @ CAMERA.T, np.array([[1.0, 0.0, 0.0]]), CAMERA
    )
    assert errors[0] == pytest.approx(7.0)


def test_what_was_not_found_errs_by_ninety_degrees() -> None:
    one = CAMERA[:, :1].T
    errors = rectification.direction_errors_deg(one, np.eye(3), CAMERA)
    assert sorted(errors.tolist()) == pytest.approx([0.0, 90.0, 90.0])
    none = rectification.direction_errors_deg(None, np.eye(3), CAMERA)
    assert none.tolist() == [90.0] * 3


def test_a_shifted_horizon_errs_by_its_shift() -> None:
    true, found = np.array([0.0, 1.0, -200.0]), np.array([0.0, -2.0, 448.0])
    assert rectification.horizon_error(found, true, (480, 640)) == pytest.approx(0.05)


def test_the_area_is_full_for_no_error_and_nothing_beyond_reach() -> None:
    area = rectification.area_under_curve
    assert area(np.zeros(4)) == 100
    assert area(np.full(4, 0.3)) == 0
    assert area(np.array([0.0, 0.25, 0.125, 0.125])) == pytest.approx(50)


def test_the_right_homography_leaves_right_angles() -> None:
    quad = np.array([[10.0, 20.0], [90.0, 5.0], [100.0, 95.0], [5.0, 80.0]])
    right = homography.between(SQUARE, quad)
    assert rectification.worst_angle_deg(quad, right) < 1e-5
    wrong = rectification.worst_angle_deg(quad, np.eye(3))
    assert wrong == pytest.approx(15.383, abs=0.001)  # top left


def test_a_torn_quad_errs_by_ninety_degrees() -> None:
    quad = np.array([[10.0, 20.0], [90.0, 5.0], [100.0, 95.0], [5.0, 80.0]])
    torn = np.linalg.inv(np.array([[1.0, 0, 0], [0, 1.0, 0], [1.0, 0, -50.0]]))
    assert rectification.worst_angle_deg(quad, torn) == 90.0


def test_a_shifted_quad_errs_by_its_shift() -> None:
    quad = np.array([[10.0, 20.0], [90.0, 20.0], [90.0, 80.0], [10.0, 80.0]])
    assert rectification.corner_error_px(quad, quad) == 0
    moved = quad + np.array([3.0, -4.0])
    assert rectification.corner_error_px(moved, quad) == pytest.approx(5.0)
    assert rectification.width_px(quad) == pytest.approx(80.0)


@pytest.mark.parametrize("turn_deg", [0.0, 1.0, 89.0])
def test_two_points_are_as_far_apart_as_the_camera_turned(turn_deg: float) -> None:
    turn = np.radians(turn_deg)
    one = CAMERA @ [0.0, 0.0, 1.0]
    other = -2.5 * (CAMERA @ [np.sin(turn), 0.0, np.cos(turn)])
    found = rectification.angle_deg(one, other, CAMERA)
    assert found == pytest.approx(turn_deg, abs=1e-9)


def test_the_true_quad_bounds_the_true_aspect_and_half_of_it_half() -> None:
    quad = np.array([[10.0, 20.0], [90.0, 5.0], [100.0, 95.0], [5.0, 80.0]])
    aspect = rectification.bounded_aspect(quad, quad, 0.7)
    assert aspect == pytest.approx(0.7)
    left_half = homography.apply(homography.between(SQUARE, quad), SQUARE * [0.5, 1.0])
    aspect = rectification.bounded_aspect(left_half, quad, 0.7)
    assert aspect == pytest.approx(0.35)
