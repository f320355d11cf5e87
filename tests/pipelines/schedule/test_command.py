"""Whatever a run ends with is recorded, and is the exit code of `--once`."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import typer
from typer.testing import CliRunner, Result

from pipelines.cli.program import app
from pipelines.store import Busy

RUN = "pipelines.cli.schedule.redone"


@pytest.fixture
def city(tmp_path: Path) -> Path:
    (tmp_path / "manifest.csv").touch()
    return tmp_path


def once(city: Path) -> Result:
    words = ["schedule", str(city), "--cron", "17 3 * * *", "--once"]
    return CliRunner().invoke(app, words)


def last(city: Path) -> dict[str, Any]:
    return json.loads((city / "schedule.json").read_text())[-1]


def fails(problem: Exception, cause: Exception | None = None) -> Any:
    def run(*_: object, **__: object) -> None:
        raise problem from cause

    return run


def made(*, held: bool) -> Any:
    report = SimpleNamespace(held=held, run="0a1b")
    plan = SimpleNamespace(photos=3, later=0)
    return lambda *_, **__: SimpleNamespace(report=report, plan=plan)


@pytest.mark.parametrize(
    ("run", "outcome", "code"),
    [
        (made(held=False), "done", 0),
        (made(held=True), "held", 3),
        (fails(RuntimeError("a runner of its own mind")), "failed", 1),
        (fails(typer.Exit(1), Busy("another run")), "busy", 1),
        (fails(typer.Exit(143)), "stopped", 143),
    ],
)
def test_what_a_run_ends_with_is_recorded_and_told(
    city: Path, monkeypatch: pytest.MonkeyPatch, run: Any, outcome: str, code: int
) -> None:
    monkeypatch.setattr(RUN, run)
    done = once(city)
    assert (done.exit_code, last(city)["outcome"]) == (code, outcome)
    assert bool(last(city)["detail"]) is (code not in (0, 3))


def test_the_text_of_what_failed_is_recorded(
    city: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(RUN, fails(ValueError("no sense")))
    once(city)
    assert last(city)["detail"] == "ValueError: no sense"


def test_nothing_is_made_where_there_is_no_city(tmp_path: Path) -> None:
    done = once(tmp_path / "nosuch")
    assert done.exit_code == 1
    assert "nostalgin index" in done.output
    assert list(tmp_path.iterdir()) == []


def test_where_nothing_is_due_it_is_told_what_is_next(
    city: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(RUN, made(held=False))
    once(city)
    done = once(city)
    assert done.exit_code == 0
    assert "nothing is due: the next time is" in done.output
    assert "T03:17+00:00" in done.output


def test_a_record_that_can_not_be_read_is_told(city: Path) -> None:
    (city / "schedule.json").mkdir()
    done = once(city)
    assert done.exit_code == 1
    assert "Is a directory" in done.output
