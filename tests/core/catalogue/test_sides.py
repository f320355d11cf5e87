import tracemalloc

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from nostalgin_core.catalogue.sides import _agreement

NUMBERS = st.integers(-5, 5).map(float) | st.floats(-1e9, 1e9)


@given(st.lists(st.tuples(NUMBERS, NUMBERS)))
def test_agreement_is_that_of_all_pairs_in_a_matrix(
    pairs: list[tuple[float, float]],
) -> None:
    x, y = np.array(pairs, float).reshape(-1, 2).T
    signs = np.sign(x[:, None] - x) * np.sign(y[:, None] - y)
    assert _agreement(x.tolist(), y.tolist()) == signs.sum() / 2


def test_agreement_of_ten_thousand_lots_needs_no_matrix() -> None:
    lots = np.random.default_rng(0).permutation(10_000).astype(float).tolist()
    tracemalloc.start()
    agreed = _agreement(lots, lots)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert agreed == 10_000 * 9_999 / 2
    assert peak < 10e6  # a matrix of bytes has 100e6
