import numpy as np
import pytest

from nostalgin_core.measure.calibration import reliability


def test_what_comes_true_as_often_as_stated_has_no_calibration_error() -> None:
    told = reliability(
        [0.2] * 10 + [0.8] * 10, [True] * 2 + [False] * 8 + [True] * 8 + [False] * 2
    )
    assert told is not None
    assert told.error == pytest.approx(0)
    assert [one.count for one in told.bins] == [10, 10]
    assert told.brier == pytest.approx(0.16)


def test_overconfidence_is_told_by_its_size() -> None:
    told = reliability([0.95] * 10, [True] * 6 + [False] * 4)
    assert told is not None
    assert told.error == pytest.approx(0.35)


def test_draws_from_stated_probabilities_are_calibrated_but_for_chance() -> None:
    rng = np.random.default_rng(5)
    stated = rng.uniform(0, 1, 20_000)
    told = reliability(
        stated.tolist(), (rng.uniform(0, 1, stated.size) < stated).tolist()
    )
    assert told is not None
    assert told.error < 0.02
    assert sum(one.count for one in told.bins) == stated.size


def test_certainty_has_a_bin_and_nothing_has_none() -> None:
    told = reliability([0.0, 1.0], [False, True])
    assert told is not None
    assert (told.bins[0].low, told.bins[-1].high) == (0, 1)
    assert reliability([], []) is None


def test_what_is_no_probability_is_refused() -> None:
    with pytest.raises(ValueError, match=r"from 0 to 1, not .*1\.2"):
        reliability([1.2], [True])
