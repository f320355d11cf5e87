"""The process that workers are forked from: it has loaded all and done nothing.

    driver, or pool of workers  <-->  mould  -->  workers of Beam

To load Beam and the stages takes a process a second and more, which each worker would
spend anew. The mould is forked before there are threads; it starts a worker for whoever
sends it an environment and a connection, tells there how it ended, and ends it by the
signal that it is sent there. A mould whose owner is gone goes, too.
"""

import atexit
import contextlib
import logging
import os
import signal
import socket
import subprocess
import threading
from collections.abc import Mapping
from functools import partial
from multiprocessing.connection import Connection, Pipe, wait
from typing import Final, NamedTuple

from pipelines.build import isolation

ASKED: Final = b"worker"
STDIN, STDOUT, STDERR = range(3)
LOST: Final = -int(signal.SIGKILL)  # what is told of a worker if nobody can tell


class Cast:
    """A worker that was forked from the mould, as its owner sees it."""

    def __init__(self, connection: Connection) -> None:
        """Hear of it by a connection."""
        self._connection = connection
        self.returncode: int | None = None

    def wait(self, timeout: float | None = None) -> int:
        """Wait until it has ended, and tell how.

        Raises:
            TimeoutExpired: if it has not ended by then.
        """
        if self.returncode is not None:
            return self.returncode
        if not self._connection.poll(timeout):
            raise subprocess.TimeoutExpired("worker", timeout or 0.0)
        try:
            code = int(self._connection.recv())
        except (EOFError, ConnectionError):
            code = LOST
        self._connection.close()
        self.returncode = code
        return code

    def poll(self) -> int | None:
        """Tell how it ended, if it has."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.wait(0.0)
        return self.returncode

    def terminate(self) -> None:
        """Ask it to end."""
        self._signal(signal.SIGTERM)

    def kill(self) -> None:
        """End it."""
        self._signal(signal.SIGKILL)

    def _signal(self, number: signal.Signals) -> None:
        if self.returncode is None:
            with contextlib.suppress(OSError):
                self._connection.send(int(number))


class Mould:
    """The mould of this process, once it has one."""

    def __init__(self) -> None:
        """Begin with none."""
        self._asking: socket.socket | None = None
        self._process = 0
        self._lock = threading.Lock()

    @property
    def ready(self) -> bool:
        """Tell whether workers may be had of it."""
        return self._asking is not None

    def fill(self) -> None:
        """Fork it now, if this process has no threads yet."""
        if self.ready or not hasattr(os, "fork") or threading.active_count() > 1:
            return
        from apache_beam.runners.worker import sdk_worker_main  # noqa: F401

        self._asking, its = socket.socketpair()
        self._process = isolation.forked(its.fileno(), partial(serve, its))
        its.close()

    def start(self, environment: Mapping[str, str]) -> Cast:
        """Start a worker in the folder and with the standard error that are ours now.

        Raises:
            OSError: if there is no mould, or it is gone.
        """
        if self._asking is None:
            raise BrokenPipeError("there is no mould")
        ours, its = Pipe()
        with self._lock:
            socket.send_fds(self._asking, [ASKED], [its.fileno(), STDERR])
        its.close()
        ours.send((dict(environment), isolation.here()))
        return Cast(ours)

    def end(self) -> None:
        """Let it go, and wait until it is gone."""
        asking, self._asking = self._asking, None
        if asking is not None:
            asking.close()
            os.waitpid(self._process, 0)


MOULD: Final = Mould()
atexit.register(MOULD.end)


class Made(NamedTuple):
    """A worker, as the mould sees it."""

    process: int
    owner: Connection
    life: Connection  # which ends with it

    def heard(self, one: Connection) -> bool:
        """Do what its owner says, or tell how it ended; false: it is no more."""
        if one is self.life:
            code = os.waitstatus_to_exitcode(os.waitpid(self.process, 0)[1])
            with contextlib.suppress(OSError):
                self.owner.send(code)
            self.owner.close()
            self.life.close()
            return False
        try:
            os.kill(self.process, self.owner.recv())
        except (EOFError, ConnectionError):  # nobody asks for it any more
            os.kill(self.process, signal.SIGKILL)
        return True


def serve(asking: socket.socket) -> None:
    """Start workers until whoever asks for them is gone."""
    for one in (signal.SIGINT, signal.SIGTERM):  # the owner hears it, and tells us
        signal.signal(one, signal.SIG_IGN)
    there: list[Made] = []
    while True:
        by = {one: made for made in there for one in (made.life, made.owner)}
        for heard in wait([asking, *by]):
            if isinstance(heard, Connection):
                made = by[heard]
                if made in there and not made.heard(heard):
                    there.remove(made)
                continue
            message, files, _, _ = socket.recv_fds(asking, len(ASKED), 2)
            if not message:  # its workers have ended, or nobody wants them any more
                for made in there:
                    os.kill(made.process, signal.SIGKILL)
                return
            there.append(made_of(Connection(files[0]), errors=files[1]))


def made_of(owner: Connection, *, errors: int) -> Made:
    """Fork a worker for its owner."""
    environment, folder = owner.recv()
    life, its = Pipe(duplex=False)
    process = os.fork()
    if not process:
        code = 1
        try:
            for file in (STDOUT, STDERR):
                os.dup2(errors, file)
            os.dup2(os.open(os.devnull, os.O_RDONLY), STDIN)
            isolation.close_all_but(its.fileno())
            readied(environment, folder)
            from pipelines.build import worker

            worker.work()
            isolation.POOL.end()  # whose CPU time counts as ours, then
            code = 0
        finally:
            os._exit(code)
    its.close()
    os.close(errors)
    return Made(process, owner, life)


def readied(environment: Mapping[str, str], folder: str) -> None:
    """Be as a process that has just begun: what was its parent's is not ours."""
    os.environ.clear()
    os.environ.update(environment)
    with contextlib.suppress(OSError):
        os.chdir(folder)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    logging.root.handlers.clear()
    from apache_beam.runners.worker.worker_id_interceptor import WorkerIdInterceptor

    isolation.POOL.forget()
    # Beam reads it when it is loaded.
    WorkerIdInterceptor._worker_id = environment.get("WORKER_ID")  # noqa: SLF001
