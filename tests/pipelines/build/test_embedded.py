"""The embedded runner keeps to this machine: its ports, its look-ups, its files."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from pipelines.build import embedded
from pipelines.build.options import options
from tests.data import ROOT
from tests.pipelines import painted

HERE = {"127.0.0.1", "::1", "localhost", "::ffff:127.0.0.1"}
needs_compiler = pytest.mark.skipif(
    not sys.platform.startswith("linux") or shutil.which("cc") is None,
    reason="no C compiler on Linux, to stand between a program and the C library",
)


@pytest.mark.parametrize(
    "beam",
    [
        [],
        ["--direct_num_workers=1"],
        ["--direct_num_workers=2", "--direct_running_mode=multi_threading"],
        ["--runner=FlinkRunner", "--direct_num_workers=2"],
    ],
)
def test_beam_makes_its_runner_itself_where_no_processes_are_asked_for(
    beam: list[str],
) -> None:
    assert embedded.runner(options("city", beam=beam)) is None


@pytest.mark.parametrize(
    "beam",
    [
        ["--direct_num_workers=2"],
        ["--direct_num_workers=0"],
        ["--direct_running_mode=multi_processing"],
    ],
)
def test_processes_are_started_by_our_own_command(beam: list[str]) -> None:
    assert embedded.runner(options("city", beam=beam)) is not None


def test_a_blank_in_the_interpreter_s_path_is_quoted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(sys, "executable", "/some folder/python")
    assert embedded.command().startswith("exec '/some folder/python' -m ")


@pytest.fixture(scope="module")
def shim(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Compile what stands between a program and the C library."""
    library = tmp_path_factory.mktemp("shim") / "noted.so"
    source = Path(__file__).parents[1] / "noted.c"
    compiled = ["cc", "-shared", "-fPIC", "-o", library, source, "-ldl"]
    subprocess.run(compiled, check=True)
    return library


def noted(shim: Path, folder: Path, *words: str) -> set[tuple[str, str]]:
    """Run Python with a home and a temporary folder of its own; tell whom it asked."""
    for name in ("home", "temporary"):
        (folder / name).mkdir()
    given = {
        "LD_PRELOAD": str(shim),
        "NOSTALGIN_NOTED": str(folder / "noted"),
        "HOME": str(folder / "home"),
        "TMPDIR": str(folder / "temporary"),
    }
    left_out = ("XDG_", "ORT_")
    kept = {k: v for k, v in os.environ.items() if not k.startswith(left_out)}
    done = subprocess.run(
        [sys.executable, *words],
        cwd=ROOT,
        env=kept | given,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    told = folder / "noted"
    lines = told.read_text().splitlines() if told.exists() else []
    return {(what, whom) for what, _, whom in (line.partition(" ") for line in lines)}


@needs_compiler
def test_look_ups_and_ports_are_noted(shim: Path, tmp_path: Path) -> None:
    port, look_up = "s.create_server(('', 0))", "s.getaddrinfo('localhost', 0)"
    asked = noted(shim, tmp_path, "-c", f"import socket as s; {port}; {look_up}")
    assert ("bind", "0.0.0.0") in asked  # noqa: S104 - what must be noticed
    assert "getaddrinfo" in {what for what, _ in asked}


@needs_compiler
@pytest.mark.parametrize("workers", ["1", "2"])
def test_a_build_asks_nobody_and_leaves_nothing_outside_the_city(
    workers: str, shim: Path, tmp_path: Path
) -> None:
    city = painted.write_city(tmp_path)
    models = ["--models", str(tmp_path / "models")]
    build = ["-m", "pipelines.cli", "build", str(city), *models]
    asked = noted(shim, tmp_path, *build, f"--direct_num_workers={workers}")
    assert {whom for _, whom in asked} <= HERE
    assert [*(tmp_path / "home").rglob("*")] == []
    assert [*(tmp_path / "temporary").rglob("*")] == []
    assert (city / "site" / "tileset.json").is_file()


def workers(city: Path) -> list[int]:
    """List the workers' processes that build a city, and their children, by number."""
    found = []
    for path in Path("/proc").glob("[0-9]*"):
        try:
            words = (path / "cmdline").read_bytes()
            folder = (path / "environ").read_bytes()
        except OSError:
            continue
        ours = str(city).encode() in folder and embedded.WORKER.encode() in words
        if ours and b"sh\0-c" not in words:
            found.append(int(path.name))
    return sorted(found)


@pytest.mark.skipif(sys.platform != "linux", reason="processes are listed in /proc")
def test_a_worker_that_is_killed_ends_the_run_in_words(tmp_path: Path) -> None:
    city = painted.write_city(tmp_path)
    words = ["-m", "pipelines.cli", "build", str(city), "--direct_num_workers=2"]
    command = [sys.executable, *words, "--models", str(tmp_path / "models")]
    given = os.environ | {"NOSTALGIN_CITY": str(city)}
    with subprocess.Popen(command, stderr=subprocess.PIPE, env=given) as driver:
        while driver.poll() is None and not (city / "artifacts").exists():
            time.sleep(0.05)
        os.kill(workers(city)[0], signal.SIGKILL)
        try:
            _, told = driver.communicate(timeout=90)
        finally:
            driver.kill()
    assert driver.returncode == 1
    assert b"a worker's process was killed: build again" in told
    assert b"Traceback" not in told
