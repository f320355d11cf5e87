import cv2
import numpy as np

from nostalgin_core.matte.target import corner, merits
from nostalgin_core.records import Box

FRAME = Box(0, 0, 300, 400)


def _wall(*polygon: tuple[int, int]) -> np.ndarray:
    canvas = np.zeros((400, 300), np.uint8)
    cv2.fillPoly(canvas, [np.array(polygon, np.int32)], 1)
    return canvas.astype(bool)


LEFT = _wall((80, 130), (150, 80), (150, 350), (80, 330))
RIGHT = _wall((151, 80), (240, 140), (240, 325), (151, 350))


def test_a_merit_is_a_share() -> None:
    likely = merits([LEFT, RIGHT], [0.1, 1.0], FRAME, None)
    assert ((likely > 0) & (likely < 1)).all()


def test_mirrored_photos_have_mirrored_merits() -> None:
    board = Box(100, 350, 140, 370)
    mirrored = Box(160, 350, 200, 370)
    one = merits([LEFT, RIGHT], [0.8, 0.8], FRAME, board)
    other = merits([LEFT[:, ::-1], RIGHT[:, ::-1]], [0.8, 0.8], FRAME, mirrored)
    np.testing.assert_allclose(one, other, atol=0.02)


def test_the_board_and_the_middle_and_certainty_speak_for_a_front() -> None:
    aside, before = Box(240, 350, 280, 370), Box(100, 350, 140, 370)
    assert merits([LEFT], [0.8], FRAME, before) > merits([LEFT], [0.8], FRAME, aside)
    assert merits([LEFT], [0.9], FRAME, before) > merits([LEFT], [0.4], FRAME, before)
    far = np.roll(LEFT, -70, axis=1)
    assert merits([LEFT], [0.8], FRAME, None) > merits([far], [0.8], FRAME, None)


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
