"""What fits in one place has a margin; what repeats, or is hardly seen, has none."""

import numpy as np
import pytest

from nostalgin_core.views.elsewhere import FEWEST, correlations, margin
from nostalgin_core.views.likeness import detail
from tests.core.views.test_views import front

ALL = np.ones((105, 75), bool)


def painted(seed: int) -> np.ndarray:
    return detail(front(seed)[::4, ::4])


def waves() -> np.ndarray:
    """Paint what repeats every 15 texels, both ways."""
    y, x = np.mgrid[:105, :75]
    return (np.sin(2 * np.pi * y / 15) * np.sin(2 * np.pi * x / 15)).astype(np.float32)


def slowly(a: np.ndarray, b: np.ndarray, both: np.ndarray) -> float:
    """Correlate two pictures as they lie, each less its own mean."""
    x, y = ((one - one.mean())[both] for one in (a, b))
    return float((x * y).sum() / np.sqrt((x * x).sum() * (y * y).sum()))


@pytest.mark.parametrize("seed", range(3))
def test_a_front_fits_itself_nowhere_better_than_where_it_lies(seed: int) -> None:
    image = painted(seed)
    assert correlations(image, image, ALL, ALL)[0, 0] == pytest.approx(1, abs=1e-3)
    assert margin(image, image, ALL, ALL) > 0.2


def test_as_they_lie_pictures_correlate_as_the_plain_sum_says() -> None:
    a, b = painted(1), painted(1) + painted(2)
    at = correlations(a, b, ALL, ALL)
    assert at[0, 0] == pytest.approx(slowly(a, b, ALL), abs=1e-3)
    assert -1 <= at.min() <= at.max() <= 1


@pytest.mark.parametrize("seeds", [(1, 2), (3, 3)])
def test_a_margin_is_the_same_either_way(seeds: tuple[int, int]) -> None:
    a, b = (painted(seed) for seed in seeds)
    seen = ALL.copy()
    seen[60:] = False
    assert margin(a, b, seen, ALL) == pytest.approx(margin(b, a, ALL, seen), abs=1e-3)


def test_what_repeats_fits_as_well_elsewhere() -> None:
    assert abs(margin(waves(), waves(), ALL, ALL)) < 0.05


def test_what_was_hardly_seen_tells_nothing() -> None:
    image, seen = painted(1), np.zeros_like(ALL)
    seen.flat[: FEWEST - 1] = True
    assert margin(image, image, seen, ALL) == 0.0
    assert margin(image, image, ALL, seen) == 0.0
