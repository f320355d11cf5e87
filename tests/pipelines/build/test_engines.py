"""Runners beside the embedded one make the same bytes, where they can be had."""

import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import grpc
import pytest
from apache_beam.portability.api import beam_job_api_pb2, beam_job_api_pb2_grpc

from pipelines.store import Store, busy
from tests.pipelines.cities import artifacts, built, copied, tree

BESIDE = Path(sys.executable).with_name("prism")
PRISM = os.environ.get("NOSTALGIN_PRISM") or shutil.which("prism")
PRISM = PRISM or (str(BESIDE) if BESIDE.is_file() else None)
FLINK_JAR = os.environ.get("NOSTALGIN_FLINK_JOB_SERVER_JAR")
FLINK_MASTER = os.environ.get("NOSTALGIN_FLINK_MASTER", "[local]")
WAIT_S = 90.0


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as server:
        return server.getsockname()[1]


@contextmanager
def running(command: Sequence[str], port: int, log: Path) -> Iterator[int]:
    """Run a server until the block ends, from when it answers at a port."""
    with log.open("wb") as said:
        server = subprocess.Popen(command, stdout=said, stderr=said)
    try:
        until = time.monotonic() + WAIT_S
        while True:
            try:
                socket.create_connection(("localhost", port), 1).close()
                break
            except OSError:
                gone = server.poll() is not None or time.monotonic() > until
                assert not gone, log.read_text()
                time.sleep(0.1)
        yield port
    finally:
        server.terminate()
        server.wait(WAIT_S)


@pytest.fixture
def workers(tmp_path: Path) -> Iterator[int]:
    """Start a pool of external workers."""
    port = free_port()
    command = [sys.executable, "-m", "pipelines.cli", "workers", "--port", str(port)]
    with running(command, port, tmp_path / "workers.log"):
        yield port


def at(job: int, workers: int) -> list[str]:
    return [
        "--runner=PortableRunner",
        f"--job_endpoint=localhost:{job}",
        "--environment_type=EXTERNAL",
        f"--environment_config=localhost:{workers}",
    ]


@pytest.mark.skipif(not PRISM, reason="no prism: run `make prism`")
def test_prism_with_external_workers_makes_the_same_bytes(
    city: Path, tmp_path: Path, workers: int
) -> None:
    assert PRISM is not None
    other, job = copied(city, tmp_path), free_port()
    command = [PRISM, f"--job_port={job}", "--serve_http=false"]
    with running(command, job, tmp_path / "prism.log"):
        report = built(other, at(job, workers))
    assert (report.photos, report.blocks) == (4, 2)
    assert tree(other) == tree(city)


def states(job: int) -> list[str]:
    """Ask a job service how its jobs stand."""
    with grpc.insecure_channel(f"localhost:{job}") as channel:
        stub = beam_job_api_pb2_grpc.JobServiceStub(channel)
        told = stub.GetJobs(beam_job_api_pb2.GetJobsRequest()).job_info
        return [beam_job_api_pb2.JobState.Enum.Name(one.state) for one in told]


@pytest.mark.skipif(not PRISM, reason="no prism: run `make prism`")
def test_sigterm_cancels_the_job_and_the_next_run_goes_on(
    city: Path, tmp_path: Path, workers: int
) -> None:
    assert PRISM is not None
    other, job = copied(city, tmp_path), free_port()
    command = [PRISM, f"--job_port={job}", "--serve_http=false"]
    models = ["--models", str(other.parent / "models")]
    words = ["-m", "pipelines.cli", "build", str(other), *models, *at(job, workers)]
    with running(command, job, tmp_path / "prism.log"):
        with subprocess.Popen(
            [sys.executable, *words], stderr=subprocess.PIPE, text=True
        ) as driver:
            while driver.poll() is None and not artifacts(other, "segment"):
                time.sleep(0.02)
            driver.send_signal(signal.SIGTERM)
            said = driver.communicate(timeout=WAIT_S)[1]
        assert driver.returncode == 128 + signal.SIGTERM
        assert "Traceback" not in said
        assert "does not say" not in said
        assert states(job) == ["CANCELLED"]
        assert not busy(Store(str(other)))
        assert not (other / "CURRENT").exists()
        before = {path: path.stat().st_mtime_ns for path in artifacts(other, "")}
        time.sleep(1)
        assert {
            path: path.stat().st_mtime_ns for path in artifacts(other, "")
        } == before
        built(other, at(job, workers))
    assert {path: path.stat().st_mtime_ns for path in before} == before
    assert tree(other) == tree(city)


@pytest.mark.skipif(not FLINK_JAR, reason="NOSTALGIN_FLINK_JOB_SERVER_JAR is not set")
def test_flink_with_external_workers_makes_the_same_bytes(
    city: Path, tmp_path: Path, workers: int
) -> None:
    other, job = copied(city, tmp_path), free_port()
    ports = ["--artifact-port=0", "--expansion-port=0", f"--job-port={job}"]
    master = f"--flink-master={FLINK_MASTER}"
    command = ["java", "-jar", str(FLINK_JAR), "--job-host=localhost", master, *ports]
    with running(command, job, tmp_path / "flink.log"):
        built(other, at(job, workers))
    assert tree(other) == tree(city)
