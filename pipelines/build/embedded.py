"""Beam's embedded runner: any interpreter starts its workers, no stranger reaches them.

Beam starts its workers by a command that a shell reads, in which a blank in the
interpreter's path ends it; it opens the ports that they call at on every interface of
the machine, to whoever comes; and it waits for ever for a worker that was killed. All
three are set right here.
"""

import contextlib
import shlex
import signal
import sys
import threading
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final
from unittest import mock

import grpc
from apache_beam.options.pipeline_options import (
    DirectOptions,
    PipelineOptions,
    StandardOptions,
)
from apache_beam.transforms.environments import SubprocessSDKEnvironment

if TYPE_CHECKING:  # its own workers load this file, too
    from apache_beam.runners.portability.fn_api_runner.fn_runner import FnApiRunner

EMBEDDED: Final = "FnApiRunner"
WORKER: Final = "pipelines.build.worker"
EVERYWHERE: Final = "[::]:"
HERE: Final = "localhost:"  # as the workers are told to call
ENDED: Final = "Worker subprocess exited"  # as Beam tells the thread that waited
SOON_S: Final = 3.0
CLOSED: Final = "Channel closed prematurely"  # and whoever sent it work


class WorkerLost(RuntimeError):  # noqa: N818 - it reads as what it is about
    """A worker that was killed: for want of memory, it may be."""


class Woken(BaseException):
    """The main thread need not wait any longer."""


def runner(options: PipelineOptions) -> "FnApiRunner | None":
    """Make the embedded runner where processes are asked of it, and change its options.

    Otherwise, and for other runners, None: Beam makes them from the options. More than
    one worker means processes, unless threads are asked for: the time between calls of
    ONNX Runtime, OpenCV and NumPy is Python's own.
    """
    if not processes(options):
        return None
    direct = options.view_as(DirectOptions)
    from apache_beam.runners.portability.fn_api_runner.fn_runner import FnApiRunner

    direct.direct_running_mode = "in_memory"  # or else Beam takes its own command
    workers = SubprocessSDKEnvironment.from_command_string(command())
    return FnApiRunner(default_environment=workers)


def processes(options: PipelineOptions) -> bool:
    """Tell whether this machine's processes are asked for."""
    direct = options.view_as(DirectOptions)
    asked = direct.direct_running_mode == "multi_processing"
    threads = direct.direct_running_mode == "multi_threading"
    many = asked or (direct.direct_num_workers != 1 and not threads)
    return many and options.view_as(StandardOptions).runner == EMBEDDED


def in_process(options: PipelineOptions) -> bool:
    """Tell whether this process does the work itself."""
    near = options.view_as(StandardOptions).runner == EMBEDDED
    return near and options.view_as(DirectOptions).direct_num_workers == 1


def command() -> str:
    """Write what a shell is to start as a worker."""
    return f"exec {shlex.quote(sys.executable)} -m {WORKER}"  # no shell stays


@contextlib.contextmanager
def ending_with_a_worker() -> Iterator[None]:
    """End what the main thread waits for when a worker is no more.

    Raises:
        WorkerLost: if one is.
    """
    main, told = threading.main_thread(), threading.excepthook
    lost, over = threading.Event(), threading.Event()

    def hook(raised: threading.ExceptHookArgs) -> None:
        if ENDED not in str(raised.exc_value) or main.ident is None:
            told(raised)
            return
        first = not lost.is_set()
        lost.set()
        if first and not over.is_set():
            signal.pthread_kill(main.ident, signal.SIGUSR1)

    def woken(*_: object) -> None:
        raise Woken

    if threading.current_thread() is not main:
        yield
        return
    before = signal.signal(signal.SIGUSR1, woken)
    with mock.patch.object(threading, "excepthook", hook):
        try:
            yield
        except (Woken, RuntimeError) as problem:
            over.set()
            if not lost.is_set() and CLOSED not in str(problem):
                raise
            lost.wait(SOON_S)  # or else its thread would print a traceback
            raise WorkerLost("a worker's process was killed") from None
        finally:
            over.set()
            signal.signal(signal.SIGUSR1, before)


@contextlib.contextmanager
def on_loopback() -> Iterator[None]:
    """Keep all ports that are opened meanwhile to this machine."""
    made = grpc.server

    def server(*args: Any, **options: Any) -> grpc.Server:
        one = made(*args, **options)
        opened = one.add_insecure_port

        def here(address: str) -> int:
            if address.startswith(EVERYWHERE):
                address = f"{HERE}{address.removeprefix(EVERYWHERE)}"
            return opened(address)

        one.add_insecure_port = here
        return one

    with mock.patch.object(grpc, "server", server):
        yield
