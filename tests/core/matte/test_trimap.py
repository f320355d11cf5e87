import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from nostalgin_core.matte.trimap import (
    BACKGROUND,
    FOREGROUND,
    UNKNOWN,
    signed_distance,
    trimap,
)


def _ramp(width_px: float) -> np.ndarray:
    """Probability that rises from left to right, one half between columns 49 and 50."""
    x = np.arange(100) - 49.5
    row = np.clip(0.5 + x / width_px, 0.0, 1.0)
    return np.tile(row.astype(np.float32), (80, 1))


def test_the_band_is_five_to_ninety_five_percent() -> None:
    probability = _ramp(20.0)
    known = trimap(probability, least_px=1.0, most_px=50.0)
    unsure = (probability > 0.05) & (probability < 0.95)
    np.testing.assert_array_equal(known == UNKNOWN, unsure)


@given(width=st.floats(0.1, 300.0))
def test_the_band_is_never_thinner_or_wider_than_told(width: float) -> None:
    band = (trimap(_ramp(width), least_px=3.0, most_px=12.0)[40] == UNKNOWN).sum()
    assert 6 <= band <= 24


def test_sides_are_known_beyond_the_band() -> None:
    known = trimap(_ramp(20.0))
    assert (known[:, :30] == BACKGROUND).all()
    assert (known[:, 70:] == FOREGROUND).all()


def test_a_wall_that_the_network_doubts_is_still_a_wall() -> None:
    known = trimap(np.full((50, 50), 0.7, np.float32))
    assert (known == FOREGROUND).all()


def test_a_mask_that_runs_into_the_rim_is_not_frayed_there() -> None:
    probability = np.zeros((60, 60), np.float32)
    probability[20:, :] = 1.0
    known = trimap(probability, least_px=3.0)
    assert (known[40:] == FOREGROUND).all()
    assert (known[19] == UNKNOWN).all()


def test_distance_changes_sign_between_pixels() -> None:
    inside = np.zeros((5, 9), bool)
    inside[:, 4:] = True
    expected = np.arange(9) - 3.5
    np.testing.assert_allclose(signed_distance(inside)[2], expected, atol=0.05)
    np.testing.assert_allclose(signed_distance(~inside)[2], -expected, atol=0.05)
