import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pipelines.build.took import EDGES_MS, Took, edge, span, up_to

times = st.lists(st.integers(0, 2_000_000), min_size=1, max_size=200)


def counted(taken: list[int]) -> Took:
    """Count as a runner does: one counter a span, in any order."""
    counts: dict[float, int] = {}
    for one in taken:
        end = edge(span(one))
        assert end is not None
        counts[end] = counts.get(end, 0) + 1
    return Took.of(counts, max(taken))


@given(times)
def test_each_time_falls_into_one_span_that_holds_it(taken: list[int]) -> None:
    took = counted(taken)
    assert took.count == len(taken)
    for end, n in up_to(took):
        assert n == sum(one <= end for one in taken)


@pytest.mark.parametrize("share", [0.5, 0.9])
@pytest.mark.parametrize("seed", range(5))
def test_a_quantile_is_right_to_an_eighth(share: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    taken = np.rint(np.exp(rng.normal(7, 0.6, 2001))).astype(int)
    found = counted(taken.tolist()).quantile_ms(share)
    assert found == pytest.approx(np.quantile(taken, share), rel=0.125)


@given(times)
def test_no_quantile_lies_beyond_the_longest(taken: list[int]) -> None:
    took = counted(taken)
    assert took.quantile_ms(0.5) <= took.quantile_ms(0.9) <= max(*taken, 1)


@given(times)
def test_a_record_gives_back_what_was_written(taken: list[int]) -> None:
    took = counted(taken)
    again = Took.read(took.told())
    assert again.spans == took.spans
    assert again.longest_ms == took.longest_ms


def test_nothing_took_no_time() -> None:
    assert Took.of({}, 0).quantile_ms(0.5) == 0
    assert edge("made") is None
    assert edge(span(EDGES_MS[-1] + 1)) == math.inf
