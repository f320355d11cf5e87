"""SIGTERM ends a run after what is in flight; the next does nothing of it twice."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from pipelines.stopping import CODES
from tests.pipelines import painted
from tests.pipelines.cities import artifacts, built, copied, tree

WAIT_S = 300.0
CRON = ("--cron", "17 3 * * *")

pytestmark = pytest.mark.timeout(900)


@pytest.fixture(scope="module")
def city(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A painted city that was built once, in this process."""
    city = painted.write_city(tmp_path_factory.mktemp("painted"))
    built(city)
    return city


def started(city: Path, command: str, *words: str) -> subprocess.Popen[str]:
    models = ["--models", str(city.parent / "models")]
    line = [sys.executable, "-m", "pipelines.cli", command, str(city), *models, *words]
    return subprocess.Popen(
        line, stderr=subprocess.PIPE, text=True, start_new_session=True
    )


def ended(one: subprocess.Popen[str]) -> int:
    said = one.communicate(timeout=WAIT_S)[1]
    assert "Traceback" not in said
    return one.returncode


def awaited(there: Callable[[], object], one: subprocess.Popen[str]) -> None:
    until = time.monotonic() + WAIT_S
    while not there():
        assert one.poll() is None
        assert time.monotonic() < until
        time.sleep(0.01)


def stopped(
    city: Path,
    command: Sequence[str],
    *,
    all_hear: bool,
    most: int,
    how: signal.Signals = signal.SIGTERM,
) -> None:
    """Ask a run to end at its first artifact of `matte`: it makes `most` more."""
    one = started(city, *command)
    awaited(lambda: artifacts(city, "matte"), one)
    before = len(artifacts(city, ""))
    if all_hear:
        os.killpg(one.pid, how)
    else:
        one.send_signal(how)
    assert ended(one) == 128 + how
    assert 128 + how in CODES
    assert len(artifacts(city, "")) - before <= most
    assert not (city / "CURRENT").exists()
    assert not list(city.rglob("*.partial"))


def made(city: Path) -> dict[Path, int]:
    return {path: path.stat().st_mtime_ns for path in artifacts(city, "")}


def assert_the_next_goes_on(city: Path, whole: Path, command: Sequence[str]) -> None:
    """Run to the end: nothing is made twice, and all is as if nobody had asked."""
    before = made(city)
    assert before
    assert ended(started(city, *command)) == 0
    assert {path: made(city)[path] for path in before} == before
    assert {**tree(city), "schedule.json": ""} == {**tree(whole), "schedule.json": ""}


@pytest.mark.parametrize("all_hear", [False, True])
@pytest.mark.parametrize("workers", [1, 2])
def test_a_build_ends_after_what_is_in_flight_and_the_next_goes_on(
    city: Path, tmp_path: Path, workers: int, *, all_hear: bool
) -> None:
    other = copied(city, tmp_path)
    command = ("build", f"--direct_num_workers={workers}")
    # What is in flight, and what came between the count and the signal.
    stopped(other, command, all_hear=all_hear, most=workers + 1)
    assert_the_next_goes_on(other, city, command)


@pytest.mark.parametrize("workers", [1, 2])
def test_ctrl_c_ends_a_build_in_words_and_the_next_goes_on(
    city: Path, tmp_path: Path, workers: int
) -> None:
    other = copied(city, tmp_path)
    command = ("build", f"--direct_num_workers={workers}")
    how = signal.SIGINT  # which a terminal sends to all processes
    stopped(other, command, all_hear=True, most=workers + 1, how=how)
    assert_the_next_goes_on(other, city, command)


def test_ctrl_c_twice_ends_a_build_at_once(city: Path, tmp_path: Path) -> None:
    other = copied(city, tmp_path)
    one = started(other, "build", "--direct_num_workers=2")
    awaited(lambda: artifacts(other, "segment"), one)
    for _ in range(2):
        os.killpg(one.pid, signal.SIGINT)
        time.sleep(0.2)
    said = one.communicate(timeout=WAIT_S)[1]
    assert one.returncode in (-signal.SIGINT, *CODES)
    assert "Traceback" not in said
    assert "press Ctrl-C again" in said


def test_a_scheduled_run_that_was_stopped_is_due_again(
    city: Path, tmp_path: Path
) -> None:
    other = copied(city, tmp_path)
    command = ("schedule", *CRON, "--once")
    stopped(other, command, all_hear=False, most=2)
    assert_the_next_goes_on(other, city, command)
    times = json.loads((other / "schedule.json").read_text())
    assert [one["outcome"] for one in times] == ["stopped", "done"]
    assert ended(started(other, *command)) == 0
    assert len(json.loads((other / "schedule.json").read_text())) == 2


def test_a_schedule_that_waits_ends_at_once_and_well(city: Path) -> None:
    one = started(city, "schedule", *CRON)
    awaited(lambda: b"SigCgt" in heard(one.pid), one)
    one.send_signal(signal.SIGTERM)
    began = time.monotonic()
    assert ended(one) == 0
    assert time.monotonic() - began < 10
    assert not (city / "schedule.json").exists()


def heard(process: int) -> bytes:
    """Read a process's status once it catches SIGTERM; else nothing."""
    told = Path(f"/proc/{process}/status").read_bytes()
    line = next(one for one in told.splitlines() if one.startswith(b"SigCgt"))
    caught = int(line.split()[1], 16) >> (signal.SIGTERM - 1) & 1
    return line if caught else b""
