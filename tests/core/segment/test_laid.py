import cv2
import numpy as np
import pytest

from nostalgin_core.homography import between
from nostalgin_core.records import Box
from nostalgin_core.segment import laid

SQUARE = np.array([[0.0, 0.0], [119.0, 0.0], [119.0, 159.0], [0.0, 159.0]])
QUADS = {
    "straight on": [[60, 40], [200, 40], [200, 240], [60, 240]],
    "from the right": [[60, 30], [200, 55], [200, 235], [60, 255]],
    "leaning": [[75, 40], [190, 30], [215, 250], [55, 245]],
}


def _front() -> np.ndarray:
    """Paint a front with windows in rows and columns."""
    image = np.full((160, 120), 170, np.uint8)
    for y in range(15, 150, 30):
        for x in range(12, 110, 24):
            image[y : y + 16, x : x + 12] = 50
    return image


def _seen(name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Photograph it: the picture, the front's mask, and where its corners are."""
    quad = np.array(QUADS[name], float)
    photo_from_front = between(SQUARE, quad)
    picture = cv2.warpPerspective(_front(), photo_from_front, (270, 290))
    mask = cv2.warpPerspective(
        np.full((160, 120), 255, np.uint8), photo_from_front, (270, 290)
    )
    return picture.astype(np.float32) / 255, mask > 128, quad


def _patch(name: str) -> tuple[laid.Patch, np.ndarray]:
    light, mask, quad = _seen(name)
    seen = laid.edges(light)
    up, along = laid.upright(seen, mask), laid.level(seen, mask)
    patch = laid.patch(seen, mask, up, along)
    assert patch is not None
    return patch, quad


@pytest.mark.parametrize("name", QUADS)
def test_a_front_laid_straight_has_level_rows_and_upright_sides(name: str) -> None:
    patch, quad = _patch(name)
    corners = (
        np.column_stack([quad, np.ones(4)]) @ np.linalg.inv(patch.photo_from_patch).T
    )
    x, y = (corners[:, :2] / corners[:, 2:]).T
    w, h = patch.size
    assert abs(y[0] - y[1]) < 0.03 * h
    assert abs(y[2] - y[3]) < 0.03 * h
    assert abs(x[0] - x[3]) < 0.03 * w
    assert abs(x[1] - x[2]) < 0.03 * w


def test_a_patch_of_a_copy_lies_where_it_does_in_the_photo() -> None:
    patch, _ = _patch("from the right")
    there = patch.enlarged((290, 270), Box(30, 50, 30 + 540, 50 + 580))
    middle = np.array([patch.size[0] / 2, patch.size[1] / 2, 1.0])
    small, large = (one.photo_from_patch @ middle for one in (patch, there))
    x, y = small[:2] / small[2]
    np.testing.assert_allclose(large[:2] / large[2], [2 * x + 30.5, 2 * y + 50.5])


def test_without_edges_rows_are_level_and_columns_upright() -> None:
    seen = laid.edges(np.full((60, 80), 0.5, np.float32))
    where = np.ones((60, 80), bool)
    np.testing.assert_allclose(laid.level(seen, where), [1, 0, 0])
    np.testing.assert_allclose(laid.upright(seen, where), [0, 1, 0])


def test_a_sliver_has_no_patch() -> None:
    seen = laid.edges(np.full((60, 80), 0.5, np.float32))
    front = np.zeros((60, 80), bool)
    front[10:20, 5] = True
    up, along = np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])
    assert laid.patch(seen, front, up, along) is None
