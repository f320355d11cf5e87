import io
import json

import pytest
from rich.console import Console

from pipelines.console import progress
from pipelines.console.progress import ONE_EACH, SELDOM, WEIGHTS, left_s, spelled
from pipelines.console.voice import Voice

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
    every = dict.fromkeys(WEIGHTS, 120) | dict.fromkeys(ONE_EACH, 100)
    assert left_s(every, every, 100, 60.0) == 0


@pytest.mark.parametrize("stage", ONE_EACH)
def test_a_store_that_holds_more_than_these_photos_gave_tells_no_time(
    stage: str,
) -> None:
    some = dict.fromkeys(WEIGHTS, 5)
    assert left_s(some, some, 14, 60.0) is not None
    assert left_s(some | {stage: 36}, some, 14, 60.0) is None


def watched(monkeypatch: pytest.MonkeyPatch, *, machine: bool) -> str:
    """Hear of 14 photos of which 3 are done, in a store that holds 36 others."""
    monkeypatch.setattr(progress, "SAY_EVERY_S", 0.0)
    heard = io.StringIO()
    voice = Voice(Console(file=heard, width=999), machine=machine)
    before = dict.fromkeys(WEIGHTS, 36)
    looks = iter([before, before | {"segment": 39}])
    watch = progress.Watch(voice, lambda: next(looks), 14)

    def once(_: float) -> bool:
        stopped.append(True)
        return len(stopped) > 1

    stopped: list[bool] = []
    monkeypatch.setattr(watch, "_stopped", once)
    with watch:
        pass
    return heard.getvalue()


def test_people_hear_what_a_run_has_made_and_not_what_the_store_holds(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    words = watched(monkeypatch, machine=False) + capsys.readouterr().out
    assert "14 photos; made since the start: segment 3, matte 0," in words
    assert "36" not in words
    assert "39" not in words


def test_machines_hear_both(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    told = json.loads(watched(monkeypatch, machine=True) + capsys.readouterr().out)
    assert (told["photos"], told["there"]["segment"], told["new"]["segment"]) == (
        14,
        39,
        3,
    )
    assert told["seconds_left"] is None


@pytest.mark.parametrize(
    ("seconds", "words"), [(5, "a minute"), (600, "10 min"), (36_000, "10 h")]
)
def test_a_time_is_told_as_people_do(seconds: int, words: str) -> None:
    assert spelled(seconds) == words
