"""Runners of clusters: what they need is asked for before they are.

Beam waits minutes, or for ever, for a host that does not answer, and tells of a lacking
package only where it is used, deep in a traceback.
"""

import importlib
import shutil
import socket
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

import grpc
from apache_beam.options.pipeline_options import (
    FlinkRunnerOptions,
    PipelineOptions,
    PortableOptions,
    StandardOptions,
)
from apache_beam.runners.runner import PipelineResult, PipelineState

from pipelines.build.embedded import EMBEDDED

WAIT_S: Final = 3.0  # for a host; one that is there answers in a second
PATIENCE_S: Final = 60.0  # for a job that is cancelled to be over
PAUSE_S: Final = 0.2
UNSURE: Final = (
    "its runner does not say that the job is over: see that it is before the next run"
)
DATAFLOW: Final = "apache_beam.runners.dataflow.internal.apiclient"
LINES: Final = 3  # at the end of what a runner says
TRACE: Final = "Traceback (most recent call last):"
WITHIN: Final = ("embed", "[local]", "[auto]", "")  # the runner starts it by itself
TROUBLES: Final = (  # what Beam's runners were seen to end with
    ValueError,
    ImportError,
    AttributeError,
    OSError,
    RuntimeError,
    grpc.RpcError,
    grpc.FutureTimeoutError,
)


class Unrun(RuntimeError):  # noqa: N818 - it reads as what it is about
    """A cluster that did not answer, or gave up."""


def equipped(runner: str, prism: str) -> None:
    """Insist on the packages that a runner needs beside Beam.

    Raises:
        ValueError: if one lacks.
    """
    if "prism" in runner.casefold() and not prism:
        raise ValueError(
            f"--runner {runner}: run `make prism`, or name it by --prism_location"
        )
    if "dataflow" not in runner.casefold():
        return
    try:
        importlib.import_module(DATAFLOW)
    except ImportError as problem:
        remedy = "install apache-beam[gcp]"
        raise ValueError(f"--runner {runner}: {problem}; {remedy}") from problem


def reached(options: PipelineOptions) -> None:
    """Insist that the host of a job answers, if one is named.

    Raises:
        Unrun: if it does not, within `WAIT_S`.
    """
    if options.view_as(StandardOptions).runner == EMBEDDED:
        return
    job = options.view_as(PortableOptions).job_endpoint or ""
    if job not in WITHIN:
        with grpc.insecure_channel(job) as channel:
            try:
                grpc.channel_ready_future(channel).result(timeout=WAIT_S)
            except grpc.FutureTimeoutError as problem:
                raise Unrun(dead("--job_endpoint", job, "no answer")) from problem
    flink = options.view_as(FlinkRunnerOptions).flink_master or ""
    if flink not in WITHIN:
        host, _, port = flink.rpartition("://")[2].rstrip("/").rpartition(":")
        try:
            socket.create_connection((host or port, port), WAIT_S).close()
        except (OSError, ValueError) as problem:
            raise Unrun(dead("--flink_master", flink, str(problem))) from problem


def dead(option: str, where: str, why: str) -> str:
    """Tell that nobody answers, and what to do."""
    return f"{option}={where}: {why}; start it there, or mend the address"


def prism(given: str | None) -> str:
    """Find Prism: as it is told, beside this interpreter, or on the path.

    Beam itself would fetch it from elsewhere.
    """
    beside = Path(sys.executable).with_name("prism")
    near = str(beside) if beside.is_file() else ""
    return given or near or shutil.which("prism") or ""


def cancelled(result: PipelineResult) -> bool:
    """Cancel a job, and tell whether it is over for sure, within `PATIENCE_S`.

    Until then its workers may write, and the city folder is still ours.
    """
    until = time.monotonic() + PATIENCE_S
    try:
        result.cancel()
        while not PipelineState.is_terminal(result.state):
            if time.monotonic() > until:
                return False
            time.sleep(PAUSE_S)
    except TROUBLES:
        return False
    return True


@contextmanager
def told(runner: str) -> Iterator[None]:
    """Tell in a line that a cluster's runner gave up; it has pages of its own.

    Raises:
        Unrun: if it did.
    """
    try:
        yield
    except TROUBLES as problem:
        words = gist(str(problem)) or type(problem).__name__
        raise Unrun(f"--runner {runner} gave up: {words}") from problem


def gist(said: str) -> str:
    """Shorten what a runner says, tracebacks and all: what failed first, and of what.

    The lines of a program are indented; of the others the first and the last few tell.
    """
    lines = [line.rstrip().removesuffix(TRACE) for line in said.split("\n")]
    plain = [line for line in lines if line and not line[0].isspace()]
    return "; ".join([*plain[:1], *plain[1:][-LINES:]])
