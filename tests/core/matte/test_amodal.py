import numpy as np
import pytest

from nostalgin_core.matte.amodal import amodal, ground_line

SIZE = (300, 240)


def _front(slope: float = 0.0) -> np.ndarray:
    """A wall from x 40 to 199 whose foot runs through y 240 at x 120."""
    y, x = np.mgrid[: SIZE[0], : SIZE[1]]
    return (x >= 40) & (x < 200) & (y >= 50) & (y <= 240 + slope * (x - 120))


def _block(x0: int, y0: int, x1: int, y1: int) -> np.ndarray:
    mask = np.zeros(SIZE, bool)
    mask[y0:y1, x0:x1] = True
    return mask


def test_a_front_that_nothing_hides_is_its_own_amodal_mask() -> None:
    front = _front(0.2)
    np.testing.assert_array_equal(amodal(front, np.zeros(SIZE, bool)), front)


def test_the_amodal_mask_adds_nothing_but_occluders() -> None:
    front, tree = _front(), _block(100, 20, 140, 290)
    whole = amodal(front & ~tree, tree)
    assert ((front & ~tree) <= whole).all()
    assert (whole <= (front | tree)).all()


@pytest.mark.parametrize("slope", [-0.15, 0.0, 0.2])
def test_a_car_gives_back_the_foot_it_hides_and_no_street(slope: float) -> None:
    front, car = _front(slope), _block(70, 200, 150, 290)
    whole = amodal(front & ~car, car)
    wrong = np.count_nonzero(whole ^ front)
    assert wrong < 0.02 * front.sum()


def test_a_lamp_post_does_not_split_the_front() -> None:
    front, post = _front(), _block(110, 0, 116, 300)
    whole = amodal(front & ~post, post)
    np.testing.assert_array_equal(whole, front)


def test_where_no_foot_is_seen_the_ground_lies_among_the_cars() -> None:
    front, cars = _front(), _block(0, 210, 240, 280)
    slope, y = ground_line(front & ~cars, cars)
    assert abs(slope) < 0.01
    assert 215 < y < 275


def test_nothing_visible_stays_nothing() -> None:
    nothing = np.zeros(SIZE, bool)
    np.testing.assert_array_equal(amodal(nothing, _front()), nothing)
