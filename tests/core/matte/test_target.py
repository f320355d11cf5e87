import cv2
import numpy as np

from nostalgin_core.matte.target import Shown, corner, merits, over_arrow
from nostalgin_core.records import Box

FRAME = Box(0, 0, 300, 400)


def _wall(*polygon: tuple[int, int]) -> np.ndarray:
    canvas = np.zeros((400, 300), np.uint8)
    cv2.fillPoly(canvas, [np.array(polygon, np.int32)], 1)
    return canvas.astype(bool)


LEFT = _wall((80, 130), (150, 80), (150, 350), (80, 330))
RIGHT = _wall((151, 80), (240, 140), (240, 325), (151, 350))


def _shown(mask: np.ndarray, score: float = 0.8) -> Shown:
    return Shown(mask, mask, score)


BOTH = [_shown(LEFT), _shown(RIGHT)]


def test_a_merit_is_a_share() -> None:
    likely = merits([_shown(LEFT, 0.1), _shown(RIGHT, 1.0)], FRAME, None, None)
    assert ((likely > 0) & (likely < 1)).all()


def test_mirrored_photos_have_mirrored_merits() -> None:
    board = Box(100, 350, 140, 370)
    mirrored = Box(160, 350, 200, 370)
    one = merits(BOTH, FRAME, board, 120.0)
    turned = [_shown(front.mask[:, ::-1]) for front in BOTH]
    other = merits(turned, FRAME, mirrored, 179.0)
    np.testing.assert_allclose(one, other, atol=0.03)


def test_the_board_and_the_middle_speak_for_a_front() -> None:
    aside, before = Box(240, 350, 280, 370), Box(100, 350, 140, 370)
    one = [_shown(LEFT)]
    assert merits(one, FRAME, before, None) > merits(one, FRAME, aside, None)
    far = [_shown(np.roll(LEFT, -70, axis=1))]
    assert merits(one, FRAME, None, None) > merits(far, FRAME, None, None)


def test_the_front_over_the_arrow_is_meant() -> None:
    board = Box(110, 350, 190, 370)
    left = merits(BOTH, FRAME, board, 120.0)
    right = merits(BOTH, FRAME, board, 180.0)
    assert left[0] > 0.5 > left[1]
    assert right[1] > 0.5 > right[0]


def test_columns_near_the_arrow_are_shared_out_among_what_stands_there() -> None:
    over = over_arrow([LEFT, RIGHT], FRAME, None, 151.0)
    assert over.sum() == 1
    assert over.min() > 0.3
    # Below the board, and where no front is, nothing is told.
    assert over_arrow([LEFT], FRAME, Box(0, 80, 40, 100), 20.0).sum() == 0


def test_roofs_rise_towards_a_corner_by_the_lesser_slope() -> None:
    rise = corner(LEFT, RIGHT)
    assert abs(rise - 60 / 89) < 0.05


def test_an_inner_corner_and_a_straight_street_are_no_corner() -> None:
    inner = np.roll(RIGHT, -71, axis=1), np.roll(LEFT, 71, axis=1)
    assert corner(*inner) < 0
    row = _wall((60, 60), (150, 90), (150, 340), (60, 360))
    further = _wall((151, 90), (240, 120), (240, 320), (151, 340))
    assert corner(row, further) < 0.05


def test_fronts_apart_or_of_unequal_height_do_not_meet() -> None:
    assert corner(LEFT, np.roll(RIGHT, 50, axis=1)) == -np.inf
    assert corner(LEFT, np.roll(RIGHT, 60, axis=0)) == -np.inf
