import numpy as np
import pytest

from export.fit_roofs import Rows, cuts, fit, lost, unlikely


def _rows(seed: int = 0, fronts: int = 60, each: int = 12) -> Rows:
    """Rows of fronts, of which every other has a roof; one feature shows it."""
    rng = np.random.default_rng(seed)
    told, gain = [], []
    for number in range(fronts):
        shows, worth = rng.normal(0, 0.3, each), np.linspace(-0.02, -0.6, each)
        if number % 2:
            roof = int(rng.integers(2, each - 2))
            shows[roof] += 3
            worth = 0.3 - 0.08 * np.abs(np.arange(each) - roof)
        told.append(np.column_stack([np.ones(each), shows, rng.normal(size=each)]))
        gain.append(worth)
    start = np.arange(fronts) * each
    return Rows(np.concatenate(told), np.concatenate(gain), start)


def test_fitted_weights_cut_at_roofs_and_nowhere_else() -> None:
    learnt, other = _rows(), _rows(seed=1)
    found = cuts(fit(learnt), other)
    gained = other.gain[found]
    assert len(found) >= 28
    assert (gained > 0.2).mean() > 0.95


@pytest.mark.parametrize("which", ["unlikely", "lost"])
def test_slopes_are_those_of_the_costs(which: str) -> None:
    rows, around = _rows(), np.array([0.1, -0.2, 0.3])

    def cost(weights: np.ndarray) -> tuple[float, np.ndarray]:
        if which == "lost":
            return lost(weights, rows, around)
        return unlikely(weights, rows)

    at = np.array([-1.0, 0.7, 0.2])
    _, slope = cost(at)
    for i, step in enumerate(np.eye(3) * 1e-5):
        near = (cost(at + step)[0] - cost(at - step)[0]) / 2e-5
        assert near == pytest.approx(slope[i], rel=1e-4, abs=1e-4)
