import numpy as np
import pytest

from nostalgin_core.rectify import contours


def square() -> np.ndarray:
    image = np.full((300, 300), 200, np.uint8)
    image[50:250, 60:240] = 60
    return image


def test_thresholds_surround_the_median() -> None:
    image = np.full((10, 10), 100, np.uint8)
    assert contours.canny_thresholds(image) == (67, 133)
    assert contours.canny_thresholds(np.zeros((10, 10), np.uint8)) == (0, 1)
    assert contours.canny_thresholds(np.full((4, 4), 250, np.uint8))[1] == 255


@pytest.mark.parametrize("shape", [(1, 1), (3, 5), (4, 7), (40, 30)])
def test_the_histograms_median_is_the_median(shape: tuple[int, int]) -> None:
    image = np.random.default_rng(shape[1]).integers(0, 256, shape, dtype=np.uint8)
    low, high = contours.canny_thresholds(image)
    median = np.median(image)
    assert low == round(0.67 * median)
    assert high == max(1, round(min(255, 1.33 * median)))


def walked(mask: np.ndarray) -> contours.Contours:
    y, x = np.nonzero(mask)
    return contours.link(mask, np.column_stack([x, y]).astype(np.float64), shortest=3)


def test_linked_points_touch_their_neighbours() -> None:
    image = square()
    mask, points = contours.edges(image, 60, 120)
    linked = contours.link(mask, points)
    same = np.diff(linked.contour) == 0
    steps = np.abs(np.diff(linked.points, axis=0)).max(axis=1)
    assert same.sum() > 500
    assert np.all(steps[same] < 1 + 2 * 0.7 + 1e-9)


@pytest.mark.parametrize("closed", [True, False])
def test_a_path_is_one_contour_with_every_point_once(*, closed: bool) -> None:
    mask = np.zeros((20, 20), bool)
    mask[5, 5:15] = mask[14, 5:15] = mask[5:15, 5] = mask[5:15, 14] = True
    if not closed:
        mask[5, 9] = False
    linked = walked(mask)
    assert linked.contour.max() == 0
    assert len(linked.points) == mask.sum()
    assert len(np.unique(linked.points, axis=0)) == mask.sum()


def test_a_crossing_is_cut_into_its_arms() -> None:
    mask = np.zeros((21, 21), bool)
    mask[10, 2:19] = mask[2:19, 10] = True
    linked = walked(mask)
    assert linked.contour.max() == 3


def test_shade_and_sun_are_evened_out() -> None:
    rng = np.random.default_rng(0)
    stripes = 20.0 * (np.indices((200, 400)).sum(axis=0) // 10 % 2)
    image = 120 + stripes + rng.normal(0, 1, stripes.shape)
    image[:, 200:] = 30 + 0.3 * (image[:, 200:] - 120)
    even = contours.even_out(image.astype(np.uint8))
    light, dark = even[:, 30:170], even[:, 230:370]
    assert abs(light.mean() - dark.mean()) < 10
    assert 0.4 < dark.std() / light.std() < 1.2


def test_an_edge_between_pixels_is_placed_between_them() -> None:
    image = np.full((40, 40), 40, np.uint8)
    image[:, 20] = 90  # the edge is nearer to the right: 25 % of the step
    image[:, 21:] = 240
    mask, points = contours.edges(image, 60, 120)
    assert mask.any()
    assert 20.1 < np.median(points[:, 0]) < 20.6
