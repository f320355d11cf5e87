"""What crashed is tried again, as a fresh build tries it; what was put aside is not."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from nostalgin_core.records import Rejection
from pipelines import build
from pipelines.build import attempt
from pipelines.build.isolation import ASIDE
from pipelines.models import Models
from pipelines.reprocess import tries
from pipelines.store import Store
from pipelines.store.versions import Versions
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


NAME = "6_1.png"
STAGES = ["segment", "rectify", "inpaint", "block"]


@pytest.mark.parametrize("stage", STAGES)
def test_a_crash_is_tried_again(
    city: Path, monkeypatch: pytest.MonkeyPatch, stage: str
) -> None:
    changing.change(city, NAME)
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


@pytest.mark.parametrize("stage", [*STAGES, "thumbnail"])
def test_what_was_put_aside_stays_there_until_somebody_asks(
    city: Path, monkeypatch: pytest.MonkeyPatch, stage: str
) -> None:
    changing.change(city, NAME)
    with monkeypatch.context() as there:
        crashing(there, stage, ASIDE)
        redone(city)
    assert planned(city).nothing
    assert planned(city).told()["left_alone"] == 1
    assert not planned(city, retry=True).nothing
    assert redone(city, "--retry").shown
    assert planned(city).told()["left_alone"] == 0


@pytest.mark.parametrize("stage", ["segment", "block", "thumbnail"])
def test_what_crashes_again_and_again_is_let_be_until_somebody_asks(
    city: Path, monkeypatch: pytest.MonkeyPatch, stage: str
) -> None:
    changing.change(city, NAME)
    with monkeypatch.context() as there:
        crashing(there, stage)
        for _ in range(tries.MOST):
            assert not planned(city).nothing
            redone(city)
        plan = planned(city)
        assert plan.nothing
        assert plan.told()["left_alone_first"] == ["6" if stage == "block" else NAME]
        redone(city, "--retry")
        assert planned(city).nothing
    assert redone(city, "--retry").shown
    assert planned(city).told()["left_alone"] == 0
    assert_equal_to_a_fresh_build(city, bytes_too=False)


def test_another_file_of_that_name_is_tried_as_often_again(
    city: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    crashing(monkeypatch, "segment")
    changing.change(city, NAME)
    for _ in range(tries.MOST):
        redone(city)
    assert planned(city).nothing
    changing.change(city, NAME, seed=10)
    redone(city)
    assert not planned(city).nothing


def test_crashes_of_other_versions_count_for_nothing(tmp_path: Path) -> None:
    store, versions = Store(str(tmp_path)), Versions.present(Models())
    tries.keep(store, versions, {"a.jpg": 2, "b.jpg": 3})
    assert tries.tries(store, versions) == {"a.jpg": 2, "b.jpg": 3}
    assert tries.tries(store, replace(versions, matte="another")) == {}
    (tmp_path / tries.TABLE).write_bytes(b"no table")
    assert tries.tries(store, versions) == {}
    tries.keep(store, versions, {})
    assert not (tmp_path / tries.TABLE).exists()
