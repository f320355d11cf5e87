import pytest

from pipelines.console.progress import SELDOM, WEIGHTS, left_s, spelled

NONE = dict.fromkeys(WEIGHTS, 0)


def test_what_is_not_begun_tells_no_time() -> None:
    assert left_s(NONE, NONE, 100, 30.0) is None


def test_half_of_each_stage_leaves_as_long_as_it_took() -> None:
    half = dict.fromkeys(WEIGHTS, 50) | {s: 50 * share for s, share in SELDOM.items()}
    assert left_s(half, half, 100, 60.0) == 60  # type: ignore[arg-type]


def test_what_was_there_before_makes_what_is_left_less() -> None:
    some = dict.fromkeys(WEIGHTS, 10)
    more = dict.fromkeys(WEIGHTS, 60)
    alone, resumed = left_s(some, some, 100, 60.0), left_s(more, some, 100, 60.0)
    assert alone is not None
    assert resumed is not None
    assert resumed < alone


def test_what_is_done_leaves_nothing() -> None:
    every = dict.fromkeys(WEIGHTS, 120)
    assert left_s(every, every, 100, 60.0) == 0


@pytest.mark.parametrize(
    ("seconds", "words"), [(5, "a minute"), (600, "10 min"), (36_000, "10 h")]
)
def test_a_time_is_told_as_people_do(seconds: int, words: str) -> None:
    assert spelled(seconds) == words
