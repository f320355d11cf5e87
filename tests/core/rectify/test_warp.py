import numpy as np
import pytest

from nostalgin_core import evidence, homography
from nostalgin_core.records import Box
from nostalgin_core.rectify import warp

FRAME = Box(0, 0, 120, 100)
SQUARE = np.array([[19.5, 9.5], [79.5, 9.5], [79.5, 89.5], [19.5, 89.5]])


def everywhere() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    image = np.random.default_rng(0).integers(1, 255, (100, 120), dtype=np.uint8)
    return image, np.ones((100, 120), np.float32), np.ones((100, 120), bool)


def test_a_level_rectangle_is_cut_out_as_it_is() -> None:
    image, alpha, amodal = everywhere()
    shape = warp.size(SQUARE, 0.75)
    assert shape == (80, 60)
    matrix = warp.photo_from_elevation(SQUARE, shape)
    gray, _, rests_on = warp.elevate(image, alpha, amodal, matrix, shape, frame=FRAME)
    np.testing.assert_array_equal(gray, image[10:90, 20:80])
    assert np.all(rests_on == evidence.PHOTOGRAPHED)


def test_an_elevations_edges_are_the_quads() -> None:
    quad = np.array([[10.0, 20.0], [90.0, 5.0], [100.0, 95.0], [5.0, 80.0]])
    matrix = warp.photo_from_elevation(quad, (70, 50))
    edges = np.array([[-0.5, -0.5], [49.5, -0.5], [49.5, 69.5], [-0.5, 69.5]])
    np.testing.assert_allclose(homography.apply(matrix, edges), quad, atol=1e-9)


def test_what_lies_outside_the_frame_is_marked_and_black() -> None:
    image, alpha, amodal = everywhere()
    quad = SQUARE - [40.0, 0.0]
    matrix = warp.photo_from_elevation(quad, (80, 60))
    gray, seen, rests_on = warp.elevate(
        image, alpha, amodal, matrix, (80, 60), frame=FRAME
    )
    assert np.all(rests_on[:, :20] == evidence.BEYOND_FRAME)
    assert np.all(rests_on[:, 20:] == evidence.PHOTOGRAPHED)
    assert not gray[:, :20].any()
    assert not seen[:, :20].any()


def test_hidden_soft_and_empty_texels_are_told_apart() -> None:
    image, alpha, amodal = everywhere()
    alpha[40:50, 40:50] = 0.0  # behind something
    alpha[60:62, 40:50] = 0.5
    amodal[10:20, 20:50] = False  # a stepped roof
    alpha[10:20, 20:50] = 0.0
    matrix = warp.photo_from_elevation(SQUARE, (80, 60))
    gray, _, rests_on = warp.elevate(
        image, alpha, amodal, matrix, (80, 60), frame=FRAME
    )
    assert np.all(rests_on[30:40, 20:30] == evidence.INPAINTED)
    assert np.all(rests_on[50:52, 20:30] == evidence.SOFT_EDGE)
    assert np.all(rests_on[:10, :30] == evidence.NOTHING)
    assert not gray[rests_on == evidence.INPAINTED].any()
    assert not gray[rests_on == evidence.NOTHING].any()


def test_a_gap_in_the_wall_is_hidden_and_not_sky() -> None:
    image, alpha, amodal = everywhere()
    amodal[50:60, 40:50] = False
    amodal[80:90, 20:30] = False
    alpha = np.where(amodal, alpha, np.float32(0))
    matrix = warp.photo_from_elevation(SQUARE, (80, 60))
    _, _, rests_on = warp.elevate(image, alpha, amodal, matrix, (80, 60), frame=FRAME)
    assert np.all(rests_on[40:50, 20:30] == evidence.INPAINTED)
    assert np.all(rests_on[70:80, :10] == evidence.INPAINTED)
    assert not np.any(rests_on == evidence.NOTHING)


@pytest.mark.parametrize("aspect", [0.01, 0.3, 1.0, 4.0, 100.0])
@pytest.mark.parametrize("scale", [1.0, 200.0])
def test_elevations_stay_small_and_keep_their_aspect(
    aspect: float, scale: float
) -> None:
    h, w = warp.size(SQUARE * scale, aspect)
    assert max(h, w) <= warp.MOST_PX
    assert w * h <= warp.MOST_MAGNIFIED * 60 * 80 * scale**2 + h + w
    if min(h, w) > 20:
        assert w / h == pytest.approx(aspect, rel=0.05)


@pytest.mark.parametrize("seed", range(8))
def test_rows_are_bounded_where_each_texel_would_be(seed: int) -> None:
    rng = np.random.default_rng(seed)
    quad = 1.4 * SQUARE - 15 + rng.normal(0, 9, (4, 2))
    shape = (int(rng.integers(1, 70)), int(rng.integers(1, 90)))
    matrix = warp.photo_from_elevation(quad, shape)
    y, x = np.mgrid[: shape[0], : shape[1]]
    u, v = homography.apply(matrix, np.column_stack([x.ravel(), y.ravel()]) * 1.0).T
    inside = (u >= 0) & (u <= FRAME.x1 - 1) & (v >= 0) & (v <= FRAME.y1 - 1)
    np.testing.assert_array_equal(
        warp.within(FRAME, matrix, shape), inside.reshape(shape)
    )


def test_a_front_wholly_outside_the_frame_has_no_texel_within() -> None:
    matrix = warp.photo_from_elevation(SQUARE + 500.0, (8, 6))
    assert not warp.within(FRAME, matrix, (8, 6)).any()
