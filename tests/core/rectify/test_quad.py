import cv2
import numpy as np

from nostalgin_core import homography
from nostalgin_core.rectify import quad

UNIT = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
TRUE = np.array([[100.0, 80.0], [260.0, 140.0], [280.0, 360.0], [90.0, 380.0]])


def painted(corners: np.ndarray) -> np.ndarray:
    mask = np.zeros((480, 360), np.uint8)
    cv2.fillConvexPoly(mask, np.rint(corners).astype(np.int32), 1)
    return mask > 0


def test_a_front_is_bounded_by_its_own_corners() -> None:
    plane = homography.between(UNIT, TRUE)
    bounds = quad.bounding(plane, quad.hull(painted(TRUE)))
    assert bounds is not None
    corners = homography.apply(plane, quad.corners_of(bounds))
    np.testing.assert_allclose(corners, TRUE, atol=2.0)


def test_every_pixel_lies_within_the_bounds() -> None:
    mask = painted(TRUE)
    mask[60:120, 150:170] = True  # a chimney
    plane = homography.between(UNIT, TRUE)
    bounds = quad.bounding(plane, quad.hull(mask))
    assert bounds is not None
    y, x = np.nonzero(mask)
    flat = homography.apply(
        np.linalg.inv(plane), np.column_stack([x, y]).astype(np.float64)
    )
    assert np.all(flat >= bounds[:2] - 1e-9)
    assert np.all(flat <= bounds[2:] + 1e-9)


def test_a_front_across_its_vanishing_line_has_no_quad() -> None:
    plane = homography.between(UNIT, TRUE)
    points = np.array([[100.0, 80.0], [260.0, 140.0], [4000.0, 380.0]])
    assert quad.bounding(plane, points) is None


def test_a_spur_of_the_outline_is_trimmed_off() -> None:
    plane = homography.between(UNIT, TRUE)
    mask = painted(TRUE)
    mask[300:310, 60:100] = True
    bounds = quad.bounding(plane, quad.hull(mask))
    assert bounds is not None
    assert bounds[0] < -0.1
    tight = quad.trimmed(mask, plane, bounds)
    np.testing.assert_allclose(tight, [0, 0, 1, 1], atol=0.03)


def test_trimming_takes_at_most_its_share() -> None:
    mask = np.zeros((480, 360), bool)
    mask[100:400, 150:160] = True  # a mast
    mask[350:400, 50:300] = True
    bounds = np.array([50.0, 100.0, 300.0, 400.0])
    tight = quad.trimmed(mask, np.eye(3), bounds)
    most = quad.MOST_TRIMMED + 0.01
    assert tight[1] <= bounds[1] + most * 300


def test_an_empty_mask_has_no_hull() -> None:
    assert quad.hull(np.zeros((10, 10), bool)).shape == (0, 2)
