"""Workers that a runner of another process, or of another machine, may ask for.

Beam has such a service, but it starts whatever PATH calls python, tells its workers no
options, and lets them hang when they have said more than a pipe holds. In Beam's own
containers a program written in Go asks the runner what a worker should know; here this
process does.
"""

import os
import signal
import subprocess
import sys
import threading
from concurrent import futures
from typing import Any, Final

import grpc
from apache_beam.portability.api import (
    beam_fn_api_pb2,
    beam_fn_api_pb2_grpc,
    beam_provision_api_pb2,
    beam_provision_api_pb2_grpc,
    endpoints_pb2,
)
from google.protobuf import json_format, text_format

from pipelines.build.embedded import WORKER

ENDPOINTS: Final = ("control", "logging", "status")
WAIT_S: Final = 60.0  # for what a runner should answer
GRACE_S: Final = 10.0


class External(beam_fn_api_pb2_grpc.BeamFnExternalWorkerPoolServicer):
    """Starts a process for each worker that is asked for, and ends it."""

    def __init__(self) -> None:
        """Begin with none."""
        self._workers: dict[str, subprocess.Popen[bytes]] = {}

    def StartWorker(self, request: Any, _: Any) -> Any:  # noqa: N802 - Beam's name
        """Start a worker that calls where it is told to."""
        try:
            env = os.environ | environment(request, provision(request))
            self._workers[request.worker_id] = started(env)
        except (OSError, grpc.RpcError) as problem:
            return beam_fn_api_pb2.StartWorkerResponse(error=str(problem))
        return beam_fn_api_pb2.StartWorkerResponse()

    def StopWorker(self, request: Any, _: Any) -> Any:  # noqa: N802 - Beam's name
        """End a worker."""
        worker = self._workers.pop(request.worker_id, None)
        if worker is not None:
            ended(worker)
        return beam_fn_api_pb2.StopWorkerResponse()

    def end(self) -> None:
        """End all."""
        while self._workers:
            ended(self._workers.popitem()[1])


def provision(request: Any) -> Any:
    """Ask the runner what a worker of its should know."""
    wanted = beam_provision_api_pb2.GetProvisionInfoRequest()
    with grpc.insecure_channel(request.provision_endpoint.url) as channel:
        stub = beam_provision_api_pb2_grpc.ProvisionServiceStub(channel)
        who = [("worker_id", request.worker_id)]
        return stub.GetProvisionInfo(wanted, timeout=WAIT_S, metadata=who).info


def environment(request: Any, info: Any) -> dict[str, str]:
    """Write what a worker of Beam reads from its environment."""
    told = {
        "WORKER_ID": request.worker_id,
        "PIPELINE_OPTIONS": json_format.MessageToJson(info.pipeline_options),
        "RUNNER_CAPABILITIES": " ".join(info.runner_capabilities),
    }
    for name in ENDPOINTS:
        endpoint = f"{name}_endpoint"
        given = getattr(request, endpoint).url if hasattr(request, endpoint) else ""
        url = getattr(info, endpoint).url or given
        if url:
            one = endpoints_pb2.ApiServiceDescriptor(url=url)
            text = text_format.MessageToString(one)
            told[f"{name.upper()}_API_SERVICE_DESCRIPTOR"] = text
    return told


def started(env: dict[str, str]) -> subprocess.Popen[bytes]:
    """Start a worker in an environment."""
    return subprocess.Popen(
        [sys.executable, "-m", WORKER],
        env=env,
        stdin=subprocess.DEVNULL,
        stdout=sys.stderr,
    )


def ended(worker: subprocess.Popen[bytes]) -> None:
    """Ask a worker to go, and see that it does."""
    worker.terminate()
    try:
        worker.wait(GRACE_S)
    except subprocess.TimeoutExpired:
        worker.kill()
        worker.wait()


def serve(host: str, port: int) -> None:
    """Give workers to whoever asks at this address, until this process is told to end.

    Raises:
        OSError: if the address can't be had.
    """
    pool = External()
    server = grpc.server(futures.ThreadPoolExecutor(max_workers=4))
    beam_fn_api_pb2_grpc.add_BeamFnExternalWorkerPoolServicer_to_server(pool, server)
    try:
        server.add_insecure_port(f"{host}:{port}")
    except RuntimeError as problem:
        raise OSError(f"{host}:{port}: {problem}") from problem
    server.start()
    over = threading.Event()
    for one in (signal.SIGTERM, signal.SIGINT):
        signal.signal(one, lambda *_: over.set())
    over.wait()
    pool.end()
    server.stop(GRACE_S).wait()
