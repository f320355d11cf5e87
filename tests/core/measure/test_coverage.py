import numpy as np
import pytest

from nostalgin_core.measure import coverage


def test_true_deviations_cover_as_often_as_they_promise() -> None:
    rng = np.random.default_rng(3)
    sds = rng.uniform(0.5, 4.0, 4000)
    found = coverage.coverage(rng.normal(0, sds), sds)
    assert found is not None
    assert found.share == pytest.approx(0.95, abs=0.01)
    assert found.low < 0.95 < found.high
    expected = (0.674, 0.994, 1.645, 1.960)
    assert found.residuals == pytest.approx(expected, abs=0.08)


def test_deviations_stated_too_small_are_found_out() -> None:
    rng = np.random.default_rng(3)
    found = coverage.coverage(rng.normal(0, 2.0, 400), np.ones(400))
    assert found is not None
    assert found.high < 0.9


def test_the_width_is_of_the_whole_interval_and_a_sign_means_nothing() -> None:
    sds = np.array([1.0, 2.0, 3.0])
    one = coverage.coverage(np.array([0.5, -9.0, 1.0]), sds)
    other = coverage.coverage(np.array([-0.5, 9.0, -1.0]), sds)
    assert one == other
    assert one is not None
    assert one.median_width == pytest.approx(2 * 1.96 * 2.0)
    assert one.share == pytest.approx(2 / 3)


def test_nothing_stated_covers_nothing() -> None:
    assert coverage.coverage(np.empty(0), np.empty(0)) is None
    with pytest.raises(ValueError, match="above 0"):
        coverage.coverage(np.ones(2), np.array([1.0, 0.0]))


def test_wilsons_bounds_are_those_of_the_textbook_and_stay_within_one() -> None:
    # Agresti and Coull 1998: 9 of 10 gives 0.596 to 0.982
    assert coverage.wilson(9, 10) == pytest.approx((0.596, 0.982), abs=0.001)
    low, high = coverage.wilson(40, 40)
    assert 0.9 < low < high <= 1 + 1e-12
    with pytest.raises(ValueError, match="no share"):
        coverage.wilson(3, 2)
