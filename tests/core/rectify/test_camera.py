import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nostalgin_core import homography
from nostalgin_core.records import Box
from nostalgin_core.rectify import camera, upright

FRAME = Box(0, 0, 600, 800)
UNIT = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
views = st.tuples(
    st.floats(400, 1200), st.floats(-6, 6), st.floats(-20, 20), st.floats(-65, 65)
)


def directions(view: tuple[float, float, float, float]) -> np.ndarray:
    _, roll, tilt, azimuth = view
    return upright.axes(np.array([0.0, *np.radians([roll, tilt, azimuth])]))


@given(view=views, aspect=st.floats(0.2, 5.0))
def test_a_painted_rectangle_tells_its_aspect(
    view: tuple[float, float, float, float], aspect: float
) -> None:
    up, across = directions(view)
    plane = np.column_stack([across * aspect, -up, [-0.3 * aspect, -0.5, 6.0]])
    quad = homography.apply(camera.matrix(view[0], FRAME) @ plane, UNIT)
    assert camera.aspect(quad, view[0], FRAME) == pytest.approx(aspect, rel=1e-6)


def test_a_level_rectangle_has_the_aspect_of_its_sides() -> None:
    quad = UNIT * [120.0, 80.0] + [33.0, 44.0]
    for focal in (100.0, 700.0, 1e5):
        assert camera.aspect(quad, focal, FRAME) == pytest.approx(1.5)


def test_three_corners_in_line_are_a_mistake() -> None:
    quad = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0]])
    with pytest.raises(ValueError, match="in line"):
        camera.aspect(quad, 500.0, FRAME)


@given(view=views)
def test_orthogonal_vanishing_points_tell_the_focal_length(
    view: tuple[float, float, float, float],
) -> None:
    up, across = directions(view) @ camera.matrix(view[0], FRAME).T
    found = camera.focal_px(up, across, FRAME)
    if found is not None:  # None: one of them is too near to infinity
        assert found == pytest.approx(view[0], rel=1e-3)


def test_a_fronto_parallel_view_tells_no_focal_length() -> None:
    right, up = np.array([1.0, 0.0, 0.0]), np.array([0.0, -1.0, 0.0])
    assert camera.focal_px(right, up, FRAME) is None


def test_one_point_at_infinity_tells_no_focal_length() -> None:
    up, across = np.array([0.0, -1.0, 0.0]), np.array([2000.0, 400.0, 1.0])
    assert camera.focal_px(up, across, FRAME) is None


def test_points_that_no_lens_makes_square_tell_none() -> None:
    one, other = np.array([900.0, 400.0, 1.0]), np.array([1500.0, 420.0, 1.0])
    assert camera.focal_px(one, other, FRAME) is None
