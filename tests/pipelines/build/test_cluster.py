import importlib
import socket
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from pipelines.build import cluster
from pipelines.build.options import CityOptions, options


@pytest.fixture
def silent() -> Iterator[str]:
    """Listen, and never answer."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield f"127.0.0.1:{server.getsockname()[1]}"


@pytest.fixture
def dead() -> str:
    """Name a port at which nobody listens."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        return f"127.0.0.1:{server.getsockname()[1]}"


@pytest.mark.parametrize("kind", ["silent", "dead"])
def test_a_job_endpoint_that_does_not_answer_is_told(
    kind: str, request: pytest.FixtureRequest
) -> None:
    where = request.getfixturevalue(kind)
    made = options("c", beam=["--runner=PortableRunner", f"--job_endpoint={where}"])
    began = time.monotonic()
    with pytest.raises(cluster.Unrun, match=f"job_endpoint={where}: no answer; start"):
        cluster.reached(made)
    assert time.monotonic() - began < 10  # seconds, as is promised


def test_a_dead_master_is_told(dead: str) -> None:
    made = options("c", beam=["--runner=FlinkRunner", f"--flink_master={dead}"])
    with pytest.raises(cluster.Unrun, match=f"flink_master={dead}: .*; start it"):
        cluster.reached(made)


@pytest.mark.parametrize(
    "beam",
    [
        [],
        ["--runner=PortableRunner", "--job_endpoint=embed"],
        ["--runner=FlinkRunner", "--flink_master=[local]"],
    ],
)
def test_what_a_runner_starts_by_itself_is_not_asked(beam: list[str]) -> None:
    cluster.reached(options("c", beam=beam))


def test_a_runner_without_its_package_is_told_with_its_name() -> None:
    try:
        importlib.import_module("google.auth")
    except ImportError:
        with pytest.raises(ValueError, match=r"install apache-beam\[gcp\]"):
            options("c", beam=["--runner=DataflowRunner"])
    else:
        pytest.skip("the package is here")


def test_what_a_runner_ends_with_is_told_in_a_line() -> None:
    said = "FlinkRunner gave up: no java; really"
    with pytest.raises(cluster.Unrun, match=said), cluster.told("FlinkRunner"):
        raise RuntimeError("no java\nreally")


def test_of_a_workers_traceback_what_failed_and_why_is_told() -> None:
    said = """job failed: bundle 3 failed:Traceback (most recent call last):
  File "a.py", line 1, in process
FileNotFoundError: no such file

During handling of the above exception, another exception occurred:

Traceback (most recent call last):
  File "b.py", line 2, in process
RuntimeError: no such file [while running 'Rows']
"""
    told = cluster.gist(said).split("; ")
    assert told[0] == "job failed: bundle 3 failed:"
    assert told[1] == "FileNotFoundError: no such file"
    assert told[-1] == "RuntimeError: no such file [while running 'Rows']"
    assert len(told) == 1 + cluster.LINES


def test_workers_elsewhere_are_told_whole_paths(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    far = ["--runner=PortableRunner", "--job_endpoint=localhost:1"]
    made = options("city", models="m", beam=far).view_as(CityOptions)
    assert (made.city, made.models) == (str(tmp_path / "city"), str(tmp_path / "m"))
    made = options("s3://bucket/city", beam=far).view_as(CityOptions)
    assert (made.city, made.models) == ("s3://bucket/city", "")
    assert options("city").view_as(CityOptions).city == "city"


@pytest.mark.parametrize("odd", ["--job_name=\udcff", "\udcff"])
def test_words_that_are_no_text_are_refused(odd: str) -> None:
    with pytest.raises(ValueError, match=r"\\xff: is not UTF-8"):
        options("c", beam=[odd])
    with pytest.raises(ValueError, match="is not UTF-8"):
        options("c", models="\udcff")


def test_prism_is_named_or_beside_and_never_fetched(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    given = ["--runner=PrismRunner", "--prism_location=/opt/prism"]
    made = options("c", beam=given).get_all_options()
    assert made["prism_location"] == "/opt/prism"
    monkeypatch.setattr(cluster.sys, "executable", "/nowhere/python")
    monkeypatch.setenv("PATH", "/nowhere")
    with pytest.raises(ValueError, match="run `make prism`"):
        options("c", beam=["--runner=PrismRunner"])
