from itertools import combinations, pairwise

import numpy as np
import pytest

from nostalgin_core.catalogue.runs import Ranges, runs


def rises(ranges: Ranges) -> bool:
    return all(a[1] < b[0] for a, b in pairwise(ranges))


@pytest.mark.parametrize("seed", range(20))
def test_a_run_is_the_longest_there_is_and_tells_who_is_not_in_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    lows = rng.integers(1, 40, 9)
    ranges = [
        (float(low), float(low + high))
        for low, high in zip(lows, rng.integers(0, 4, 9), strict=True)
    ]
    up, down = runs(ranges)
    for found, own in ((up, ranges), (down, [(-b, -a) for a, b in ranges])):
        every = [
            set(some)
            for count in range(1, 10)
            for some in combinations(range(9), count)
            if rises([own[i] for i in some])
        ]
        longest = max(map(len, every))
        best = [some for some in every if len(some) == longest]
        in_some, in_all = set.union(*best), set.intersection(*best)
        assert found.length == longest
        assert set(found.out) == set(range(9)) - in_some
        assert set(found.doubtful) == in_some - in_all


def test_nothing_runs_nowhere() -> None:
    up, down = runs([])
    assert (up.length, down.length) == (0, 0)
