"""The process that keeps a child at work, and outlives whatever becomes of it.

    worker of Beam  <-->  supervisor  <-->  child, which does a stage's work

A child that dies, or takes longer than it may, is replaced by another fork of the
supervisor, which has loaded everything and done nothing. An element whose child died
twice is given back as such. When the worker is gone, so are both.
"""

import contextlib
import ctypes
import logging
import os
import pickle
import resource
import signal
import sys
import time
from collections.abc import Callable
from multiprocessing.connection import Connection, Pipe, wait
from pathlib import Path
from typing import Any, Final, NamedTuple, NoReturn

from pipelines.models import one_thread

ATTEMPTS: Final = 2  # what another process did may kill one
GIBIBYTE: Final = 1 << 30
KIBIBYTES_A_MEGABYTE: Final = 1e6 / 1024
SPENT, FRESH = b"spent", b"fresh"  # whether a child may be asked again
PDEATHSIG: Final = 1  # of prctl: the signal that a child gets when its parent dies

Function = Callable[[Any], Any]


class Limits(NamedTuple):
    """What a stage may take for one element."""

    seconds: float = 300.0  # none: the worker does the work itself
    gigabytes: float = 4.0


class Done(NamedTuple):
    """What came of an element, and what it took."""

    result: Any
    cpu_s: float
    healed: int  # damaged artifacts that were made again
    skipped: bool = False  # all was there already
    peak_mb: float = 0.0  # of the memory of the process that did it, so far


class Failed(NamedTuple):
    """What was raised: its text, and whether it ends the run."""

    text: str
    fatal: bool


class Died(NamedTuple):
    """How the children ended that an element was given to."""

    how: tuple[str, ...]


class Child:
    """A process that does one piece of work after another."""

    def __init__(self, limits: Limits, worker: Connection) -> None:
        """Fork one, which has no business with the worker."""
        self.limits = limits
        self.connection, its = Pipe()
        self._pid = os.fork()
        if not self._pid:
            worker.close()
            self.connection.close()
            work(its, limits)
        its.close()

    def idle(self) -> bool:
        """Tell whether it is there still, and waits: unasked it says nothing."""
        return not self.connection.poll()

    def end(self) -> str:
        """Kill it if it has not died, and tell how it ended."""
        self.connection.close()
        with contextlib.suppress(ProcessLookupError):
            os.kill(self._pid, signal.SIGKILL)
        code = os.waitstatus_to_exitcode(os.waitpid(self._pid, 0)[1])
        return signal.Signals(-code).name if code < 0 else f"exit code {code}"


class Crew:
    """One child at a time, and another in its place when it dies."""

    def __init__(self, worker: Connection) -> None:
        """Serve this worker."""
        self._worker = worker
        self._child: Child | None = None

    def answer(self, limits: Limits, request: bytes) -> bytes:
        """Have a child answer a request.

        Raises:
            EOFError: if the worker is gone.
        """
        how: list[str] = []
        while len(how) < ATTEMPTS:
            child = self._ready(limits)
            with contextlib.suppress(ConnectionError):  # it will be heard of at once
                child.connection.send_bytes(request)
            heard = wait([child.connection, self._worker], limits.seconds)
            if self._worker in heard:
                raise EOFError
            try:
                if heard:
                    return self._heard(child)
                how.append(f"more than {limits.seconds:g} s")
                self.end()
            except (EOFError, ConnectionError):
                how.append(self.end())
        return pickle.dumps(Died(tuple(how)))

    def end(self) -> str:
        """End the child there is, and tell how it ended."""
        child, self._child = self._child, None
        return "" if child is None else child.end()

    def _heard(self, child: Child) -> bytes:
        answer = child.connection.recv_bytes()
        if child.connection.recv_bytes() == SPENT:
            self.end()
        return answer

    def _ready(self, limits: Limits) -> Child:
        if self._child and not (self._child.idle() and self._child.limits == limits):
            self.end()
        self._child = self._child or Child(limits, self._worker)
        return self._child


def serve(worker: Connection) -> None:
    """Answer a worker until it is gone, with one thread a library."""
    one_thread()  # whoever it was forked from, or else sums differ in their last bits
    for one in (signal.SIGINT, signal.SIGTERM):  # the worker hears it, and goes
        signal.signal(one, signal.SIG_IGN)
    crew = Crew(worker)
    try:
        while True:
            limits, request = pickle.loads(worker.recv_bytes())  # noqa: S301 - our own
            worker.send_bytes(crew.answer(Limits(*limits), request))
    except (EOFError, ConnectionError):
        crew.end()


def work(supervisor: Connection, limits: Limits) -> NoReturn:
    """Do what is asked until nobody is there to ask."""
    confine(limits)
    functions: dict[bytes, Function] = {}  # with the networks that they have loaded
    try:
        while True:
            request = pickle.loads(supervisor.recv_bytes())  # noqa: S301 - our own
            function, element, folder = request
            with contextlib.suppress(OSError):
                os.chdir(folder)  # it may have been forked in another
            if function not in functions:
                functions[function] = pickle.loads(function)  # noqa: S301 - our own
            answer = done(functions[function], pickle.loads(element), limits)  # noqa: S301
            supervisor.send_bytes(pickle.dumps(answer))
            short = isinstance(answer, Failed) and answer.text.startswith("MemoryError")
            supervisor.send_bytes(SPENT if short else FRESH)
    except (EOFError, ConnectionError):
        pass
    os._exit(0)


def confine(limits: Limits) -> None:
    """Limit this process's memory, and have it end with its parent."""
    most = round(limits.gigabytes * GIBIBYTE)
    with contextlib.suppress(OSError, ValueError):  # where there is no such limit
        resource.setrlimit(resource.RLIMIT_DATA, (most, most))
    with contextlib.suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PDEATHSIG, signal.SIGKILL)


def done(function: Function, element: Any, limits: Limits) -> Done | Failed:
    """Work on one element, and tell what came of it or what was raised."""
    began = time.thread_time()
    try:
        result = function(element)
        return Done(result, time.thread_time() - began, *noticed(function), peak_mb())
    except MemoryError:
        told = f"MemoryError: it asked for more than {limits.gigabytes:g} GB"
        return Failed(told, fatal=False)
    except Exception as problem:  # noqa: BLE001 - the worker will raise it
        return Failed(repr(problem), fatal=False)
    except SystemExit as problem:
        os._exit(problem.code if isinstance(problem.code, int) else 1)
    except BaseException as problem:  # noqa: BLE001 - what ends a run
        return Failed(str(problem), fatal=True)


def noticed(function: Function) -> tuple[int, bool]:
    """Ask a function how many artifacts it made again, and whether it made none."""
    ask = getattr(function, "noticed", None)
    return ask() if ask is not None else (0, False)


def peak_mb() -> float:
    """Tell the most memory that this process has held; 0 where nothing tells it.

    `ru_maxrss` would not do: a child begins with its parent's.
    """
    with contextlib.suppress(OSError), Path("/proc/self/status").open() as told:
        for line in told:
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) / KIBIBYTES_A_MEGABYTE
    return 0.0


def main() -> None:
    """Serve the worker at the other end of a connection that was left open for us."""
    logging.getLogger().setLevel(logging.ERROR)  # Beam warns while it is imported
    import pipelines.build.blocks  # noqa: F401 - what all children will need

    serve(Connection(int(sys.argv[1])))
