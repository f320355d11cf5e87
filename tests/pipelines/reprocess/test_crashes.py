"""What crashed is tried again, as a fresh build tries it; what was put aside is not."""

from pathlib import Path
from typing import Any

import pytest

from nostalgin_core.records import Rejection
from pipelines import build
from pipelines.build import attempt
from pipelines.build.isolation import ASIDE
from tests.pipelines.reprocess import changing
from tests.pipelines.reprocess.changing import planned
from tests.pipelines.reprocess.test_reprocess import (
    assert_equal_to_a_fresh_build,
    current,
    redone,
    tables,
)


def crashing(monkeypatch: pytest.MonkeyPatch, stage: str, why: str = "") -> None:
    """Let a stage raise, or decline for a reason."""
    work = attempt.Attempt._done

    def done(one: attempt.Attempt, element: Any) -> Any:
        if one._stage() != stage:
            return work(one, element)
        if not why:
            raise MemoryError
        known = Rejection(attempt.subject(element), stage, why)
        return attempt.Done(known, 0.0, 0)

    monkeypatch.setattr(attempt.Attempt, "_done", done)


def crashed(city: Path) -> set[str]:
    rows = tables(city)["rejections.parquet"]
    return {one["stage"] for one in rows if one["reason"] == build.CRASHED}


STAGES = ["segment", "rectify", "inpaint", "block"]


@pytest.mark.parametrize("stage", STAGES)
def test_a_crash_is_tried_again(
    city: Path, monkeypatch: pytest.MonkeyPatch, stage: str
) -> None:
    changing.change(city, "6_1.png")
    with monkeypatch.context() as there:
        crashing(there, stage)
        redone(city)
        assert crashed(city) == {stage}
        run = current(city)
        assert not planned(city).nothing
        redone(city)  # which crashes again: the run stays the one it is
        assert current(city) == run
    assert redone(city).shown
    assert planned(city).nothing
    assert_equal_to_a_fresh_build(city, bytes_too=False)


@pytest.mark.parametrize("stage", STAGES)
def test_what_was_put_aside_stays_there(
    city: Path, monkeypatch: pytest.MonkeyPatch, stage: str
) -> None:
    changing.change(city, "6_1.png")
    crashing(monkeypatch, stage, ASIDE)
    redone(city)
    assert planned(city).nothing
