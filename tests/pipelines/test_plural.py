"""One is one, and many are counted in thousands."""

import pytest

from pipelines import plural


@pytest.mark.parametrize(
    ("count", "text"),
    [(0, "0 blocks"), (1, "1 block"), (2, "2 blocks"), (720_000, "720,000 blocks")],
)
def test_one_is_one(count: int, text: str) -> None:
    assert plural.of(count, "block") == text


def test_what_takes_no_s_is_named() -> None:
    assert plural.of(2, "photo or block", "photos and blocks") == "2 photos and blocks"
