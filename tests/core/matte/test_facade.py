from dataclasses import replace

import cv2
import numpy as np
import pytest

from nostalgin_core.matte.facade import arrange, covered_by
from nostalgin_core.records import Box, Facade, Instance, Photo, Rejection

SIZE = (400, 300)


def _instance(
    polygon: list[tuple[int, int]],
    category: str = "facade",
    *,
    score: float = 0.9,
    probability: float = 1.0,
) -> Instance:
    """An instance whose mask is a polygon filled evenly."""
    canvas = np.zeros(SIZE, np.float32)
    cv2.fillPoly(canvas, [np.array(polygon, np.int32)], probability)
    xs, ys = np.flatnonzero(canvas.any(0)), np.flatnonzero(canvas.any(1))
    box = Box(int(xs[0]), int(ys[0]), int(xs[-1]) + 1, int(ys[-1]) + 1)
    inside = canvas[box.y0 : box.y1, box.x0 : box.x1]
    return Instance(category, score, box, inside)


def _rectangle(
    x0: int, y0: int, x1: int, y1: int, *rest: str, **options: float
) -> Instance:
    corners = [(x0, y0), (x1 - 1, y0), (x1 - 1, y1 - 1), (x0, y1 - 1)]
    return _instance(corners, *rest, **options)


PHOTO = Photo("a photo", np.zeros(SIZE, np.uint8), Box(0, 0, SIZE[1], SIZE[0]))
ROW = [
    _rectangle(100, 80, 200, 340),
    _rectangle(10, 120, 100, 340),
    _rectangle(200, 60, 290, 340),
]


def _made(*instances: Instance) -> tuple[Facade, ...]:
    facades = arrange(PHOTO, instances)
    assert isinstance(facades, tuple)
    return facades


def test_fronts_are_numbered_from_left_to_right() -> None:
    facades = _made(*ROW)
    assert [f.index for f in facades] == [0, 1, 2]
    lefts = [int(np.flatnonzero(f.mask.any(0))[0]) for f in facades]
    assert lefts == [10, 100, 200]


def test_no_pixel_belongs_to_two_fronts_and_the_more_probable_wins() -> None:
    sure = _rectangle(50, 80, 180, 340, probability=0.9)
    unsure = _rectangle(120, 80, 280, 340, probability=0.7, score=0.95)
    left, right = _made(sure, unsure)
    assert not (left.mask & right.mask).any()
    assert left.mask[200, 150]
    assert right.mask[200, 200]


def test_what_stands_before_a_front_is_not_visible_but_is_amodal() -> None:
    car = _rectangle(120, 300, 190, 360, "vehicle")
    _, middle, _ = _made(*ROW, car)
    hidden = covered_by([car], SIZE)
    assert not (middle.mask & hidden).any()
    assert middle.amodal[320, 150]
    np.testing.assert_array_equal(middle.amodal & ~hidden, middle.mask)


def test_what_a_car_hides_below_the_front_belongs_to_the_street() -> None:
    car = _rectangle(120, 300, 190, 390, "vehicle")
    middle = _made(*ROW, car)[1]
    assert not middle.amodal[385].any()


def test_without_occluders_amodal_and_alpha_are_the_mask() -> None:
    for facade in _made(*ROW):
        np.testing.assert_array_equal(facade.amodal, facade.mask)
        np.testing.assert_array_equal(facade.alpha, facade.mask.astype(np.float32))


def test_a_front_found_twice_is_kept_once() -> None:
    again = _rectangle(102, 84, 196, 338, score=0.5)
    assert len(_made(*ROW, again)) == 3


def test_a_hole_that_nothing_explains_is_front() -> None:
    front = ROW[0]
    probability = front.probability.copy()
    probability[100:110, 40:50] = 0.1
    (facade,) = _made(replace(front, probability=probability))
    assert facade.mask[185, 145]


def test_the_order_of_instances_does_not_matter() -> None:
    board = _rectangle(130, 345, 180, 365, "placard")
    forwards, backwards = _made(*ROW, board), _made(board, *reversed(ROW))
    for one, other in zip(forwards, backwards, strict=True):
        np.testing.assert_array_equal(one.mask, other.mask)
        assert one.target == other.target


@pytest.mark.parametrize(("x", "meant"), [(30, 0), (130, 1), (220, 2)])
def test_the_board_speaks_for_the_front_it_stands_before(x: int, meant: int) -> None:
    near = _rectangle(x, 345, x + 40, 365, "placard")
    scores = [f.target_score for f in _made(*ROW, near)]
    without = [f.target_score for f in _made(*ROW)]
    gains = np.array(scores) - without
    assert gains[meant] >= gains.max() - 1e-6


def test_without_board_the_middle_front_is_the_target() -> None:
    assert [f.target for f in _made(*ROW)] == [False, True, False]


def test_a_corner_building_has_two_targets() -> None:
    left = _instance([(80, 130), (150, 80), (150, 350), (80, 330)])
    right = _instance([(151, 80), (240, 140), (240, 325), (151, 350)])
    assert [f.target for f in _made(left, right)] == [True, True]


def test_two_fronts_of_one_street_are_two_buildings() -> None:
    left = _instance([(60, 60), (150, 90), (150, 340), (60, 360)])
    right = _instance([(151, 90), (240, 120), (240, 320), (151, 340)])
    assert sum(f.target for f in _made(left, right)) == 1


def test_a_photo_whose_fronts_are_all_hidden_is_rejected() -> None:
    wall = _rectangle(0, 0, 300, 400, "vegetation")
    answer = arrange(PHOTO, [*ROW, wall])
    assert isinstance(answer, Rejection)
    assert answer.reason == "no facade left"
