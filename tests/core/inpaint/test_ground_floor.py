import numpy as np
import pytest

from nostalgin_core.inpaint.ground_floor import DARKER, darkening, low
from nostalgin_core.inpaint.repetition import guess


def at_foot(h: int, w: int, *, rows: int) -> np.ndarray:
    """Hide the lowest rows of a front."""
    hole = np.zeros((h, w), bool)
    hole[h - rows :] = True
    return hole


def test_nothing_known_is_darkened() -> None:
    rng = np.random.default_rng(0)
    hole = rng.random((80, 60)) < 0.7
    assert (darkening(hole)[~hole] == 1).all()
    assert (darkening(np.ones((9, 7), bool)) == 1).all()
    assert (darkening(np.zeros((9, 7), bool)) == 1).all()


def test_a_hole_high_on_a_front_is_not_darkened() -> None:
    hole = np.zeros((200, 100), bool)
    hole[10:100, 5:95] = True
    assert (darkening(hole) == 1).all()


def test_a_fill_is_darker_the_deeper_it_lies_and_by_a_bounded_share() -> None:
    factor = darkening(at_foot(200, 60, rows=60))
    assert (np.diff(factor[:, 30]) <= 0).all()
    assert factor[150, 30] < 1
    assert factor[-1, 30] == pytest.approx(1 - DARKER, abs=1e-3)
    assert factor.min() >= 1 - DARKER - 1e-6


@pytest.mark.parametrize("times", [2, 3])
def test_a_larger_picture_of_the_front_is_darkened_alike(times: int) -> None:
    hole = at_foot(120, 90, rows=40)
    large = np.kron(hole, np.ones((times, times), bool))
    middle = darkening(large)[times // 2 :: times, times // 2 :: times]
    assert np.abs(middle - darkening(hole)).max() < 0.01


def test_the_foot_belongs_to_the_ground_floor_and_the_upper_half_does_not() -> None:
    rows = low(100)
    assert (rows[:50] == 0).all()
    assert (rows[-25:] == 1).all()


def test_a_ground_floor_darker_than_the_floors_above_is_guessed_better_for_it() -> None:
    image = np.full((180, 120), 170, np.float32)
    image[120:] = 120
    hole = at_foot(180, 120, rows=70)
    made = guess(np.where(hole, 0, image).astype(np.float32), hole)
    bright = np.abs(170 - image)[hole].mean()
    assert np.abs(made - image)[hole].mean() < 0.85 * bright
