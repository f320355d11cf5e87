import numpy as np
import pytest

from nostalgin_core import quantise

VALUES = np.random.default_rng(3).random((20, 30))


def test_rounding_twice_is_rounding_once() -> None:
    once = quantise.soft(VALUES)
    assert np.array_equal(quantise.soft(once), once)


def test_rounding_moves_no_value_by_more_than_half_a_step() -> None:
    moved = np.abs(quantise.soft(VALUES) - VALUES).max()
    assert moved <= 0.5 / quantise.STEPS + 1e-7


def test_an_8_bit_image_holds_every_level() -> None:
    levels = np.arange(256).reshape(16, 16)
    soft = quantise.soft(levels / quantise.STEPS)
    assert np.array_equal(np.rint(soft * quantise.STEPS), levels)


@pytest.mark.parametrize("value", [-0.5, 1.5])
def test_values_beyond_the_ends_are_the_ends(value: float) -> None:
    assert quantise.soft(np.full((2, 2), value)).max() == np.clip(value, 0, 1)
