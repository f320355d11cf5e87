"""All pairs at once cost what each costs by itself, to the last bit."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from nostalgin_core.placard import misread, pairs
from nostalgin_core.placard.misread import Key

TEXTS = st.lists(st.text("0123456789-MSBOI| ", max_size=30), min_size=1, max_size=5)
HALF = st.text("0123456789-aS\u0130", min_size=1, max_size=14)
KEYS = st.lists(st.tuples(HALF, HALF), min_size=1, max_size=5)


def slowly(text: str, key: Key) -> float:
    block, lot = misread.halves(key)
    half = min(misread.apart(text, block), misread.apart(text, f"-{lot}"))
    return min(misread.whole(text, key), misread.HALF + half)


@settings(max_examples=60, deadline=None)
@given(texts=TEXTS, keys=KEYS)
@example(texts=["", "9" * 25], keys=[("9" * 24, "1"), ("1", "1")])
@example(texts=["99 -1M", "99-1 M"], keys=[("99", "1"), ("99", "11"), ("98", "1")])
def test_each_pair_costs_what_it_costs_alone(texts: list[str], keys: list[Key]) -> None:
    alone = np.array([[slowly(text, key) for key in keys] for text in texts])
    np.testing.assert_array_equal(pairs.costs(texts, keys), alone)


def test_how_many_are_weighed_at_once_does_not_matter(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    texts = [f"{n} -{n % 7}M" for n in range(90, 130)]
    keys = [(str(n), str(n % 5)) for n in range(90, 120)]
    whole = pairs.costs(texts, keys)
    monkeypatch.setattr(pairs, "AT_ONCE", 64)
    np.testing.assert_array_equal(pairs.costs(texts, keys), whole)
