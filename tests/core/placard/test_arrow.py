import cv2
import numpy as np
import pytest

from nostalgin_core.placard import arrow
from nostalgin_core.placard.arrow import USUAL
from nostalgin_core.records import Box, Photo

BOARD = Box(120, 300, 240, 330)


def _photo(tip_x: int | None, *, seed: int = 3) -> Photo:
    """A dark board on a gray street; its white arrow's tip stands at a column."""
    image = np.full((400, 360), 110.0)
    image[BOARD.y0 : BOARD.y1, BOARD.x0 : BOARD.x1] = 25
    if tip_x is not None:
        top = BOARD.y0 - 16
        corners = [[tip_x, top], [tip_x - 8, BOARD.y0], [tip_x + 8, BOARD.y0]]
        cv2.fillPoly(image, [np.array(corners, np.int32)], 235)
    image += np.random.default_rng(seed).normal(0, 4, image.shape)
    return Photo("x", np.clip(image, 0, 255).astype(np.uint8), Box(0, 0, 360, 400))


@pytest.mark.parametrize("tip_x", [175, 187, 196])
def test_an_arrow_is_found_to_two_pixels(tip_x: int) -> None:
    found = arrow(_photo(tip_x), BOARD)
    assert found.x == pytest.approx(tip_x, abs=2)
    assert found.y == pytest.approx(BOARD.y0 - 16, abs=3)
    assert found.sure > 0.6


def test_where_no_arrow_is_seen_it_is_taken_to_stand_where_most_do() -> None:
    found = arrow(_photo(None), BOARD)
    assert found.sure == 0
    assert found.x == BOARD.x0 + USUAL * 120


def test_a_board_at_the_rim_or_as_small_as_a_pixel_breaks_nothing() -> None:
    for board in (Box(0, 0, 30, 8), Box(350, 395, 360, 400), Box(5, 5, 6, 6)):
        assert 0 <= arrow(_photo(None), board).x < 360
