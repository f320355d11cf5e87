"""Work that may crash, hang or eat memory is done in a process of its own.

A function and an element go to a `supervisor`, and what came of them comes back. An
element whose process died twice is put aside: the store remembers it, so that no
later run dies of it again.
"""

import atexit
import contextlib
import os
import pickle
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Connection, Pipe
from pathlib import Path
from typing import Any, Final

from nostalgin_core.records import Rejection
from pipelines.build import supervisor
from pipelines.build.supervisor import ATTEMPTS, Died, Done, Failed, Limits
from pipelines.store import Aside, Unstored

ASIDE: Final = "put aside"
MOST_FILES: Final = 1 << 16  # that a process may well have open
MEMBER: Final = 1 / 30  # of an element's time, for each member of a group
REMEDY: Final = "`nostalgin build --retry` tries it again, with the limits given then"


class Crashed(Exception):  # noqa: N818 - it reads as what it is about
    """An exception of another process, by its text."""

    def __repr__(self) -> str:
        """Give that text."""
        return str(self)


class Supervisor:
    """A supervisor's process, as a worker sees it."""

    def __init__(self) -> None:
        """Start one: by a fork where this process has no other thread of Python.

        A fork shares what is loaded; a thread might hold a lock that it would take
        with it.
        """
        self._connection, its = Pipe()
        fork = hasattr(os, "fork") and threading.active_count() == 1
        self._wait = forked(its) if fork else started(its)
        its.close()

    def ask(
        self, function: bytes, element: Any, limits: Limits
    ) -> Done | Failed | Died:
        """Have a function applied to an element.

        Raises:
            EOFError: if the supervisor itself was killed.
        """
        request = pickle.dumps((function, pickle.dumps(element), here()))
        self._connection.send_bytes(pickle.dumps((tuple(limits), request)))
        return pickle.loads(self._connection.recv_bytes())  # noqa: S301 - our own

    def end(self) -> None:
        """Let it go, and wait until it is gone."""
        self._connection.close()
        self._wait()


def here() -> str:
    """Name the folder that relative paths begin in; none if it is no more."""
    try:
        return str(Path.cwd())
    except FileNotFoundError:
        return ""


def forked(its: Connection) -> Callable[[], object]:
    """Fork a supervisor; of what this process has open it keeps its connection."""
    process = os.fork()
    if not process:
        try:
            os.closerange(3, its.fileno())
            os.closerange(its.fileno() + 1, MOST_FILES)
            supervisor.serve(its)
        finally:
            os._exit(0)  # whatever happens, no copy of this process goes on
    return partial(os.waitpid, process, 0)


def started(its: Connection) -> Callable[[], object]:
    """Start a supervisor from the beginning."""
    paths = [path or here() for path in sys.path]  # it may have begun in another folder
    start = f"import {supervisor.__name__} as one; one.main()"  # under its own name
    known = f"import sys; sys.path[:] = {paths!r}; {start}"
    command = [sys.executable, "-c", known, str(its.fileno())]
    return subprocess.Popen(command, pass_fds=[its.fileno()]).wait


class Pool:
    """The supervisors of this process: one for each thread that has work."""

    def __init__(self) -> None:
        """Begin with none."""
        self._lock = threading.Lock()
        self._free: list[Supervisor] = []

    def fill(self) -> None:
        """Start one now, while this process has no threads yet."""
        if not self._free:
            self._free.append(Supervisor())

    @contextlib.contextmanager
    def one(self) -> Iterator[Supervisor]:
        """Lend a supervisor; one that failed its borrower is not lent again."""
        with self._lock:
            lent = self._free.pop() if self._free else None
        lent = lent or Supervisor()
        try:
            yield lent
        except (EOFError, ConnectionError):
            lent.end()
            raise
        with self._lock:
            self._free.append(lent)

    def end(self) -> None:
        """Let all go."""
        while self._free:
            self._free.pop().end()


POOL: Final = Pool()
atexit.register(POOL.end)


@dataclass
class Isolation:
    """How elements are worked on so that they harm nobody but themselves."""

    limits: Limits
    aside: Aside

    def done(self, function: bytes, element: Any, *, stage: str, key: str) -> Done:
        """Apply a pickled function to an element that rejections call `key`.

        Raises:
            Crashed: if it raised.
            Unstored: if what it made can't be kept.
        """
        limits = self.limits
        if isinstance(element, tuple):  # a group, whose parts may be read but once
            element = element[0], {k: list(v) for k, v in element[1].items()}
            limits = of_group(limits, max(map(len, element[1].values()), default=0))
        known = self.aside.of(stage, element)
        if known is not None:
            return Done(known, 0.0, 0)
        answer = self._asked(function, element, limits)
        if isinstance(answer, Done):
            self.aside.forget(stage, element)
            return answer
        if isinstance(answer, Failed):
            raise Unstored(answer.text) if answer.fatal else Crashed(answer.text)
        how = " and ".join(dict.fromkeys(answer.how))
        detail = f"its process died {len(answer.how)} times ({how}): {REMEDY}"
        why = Rejection(key, stage, ASIDE, detail)
        self.aside.put(stage, element, why)
        return Done(why, 0.0, 0)

    def _asked(
        self, function: bytes, element: Any, limits: Limits
    ) -> Done | Failed | Died:
        for _ in range(ATTEMPTS):
            with contextlib.suppress(EOFError, ConnectionError), POOL.one() as one:
                return one.ask(function, element, limits)
        return Died(("its supervisor was killed",) * ATTEMPTS)


def of_group(limits: Limits, members: int) -> Limits:
    """Give a block the more time the more facades it has, which it compares."""
    return limits._replace(seconds=limits.seconds * (1 + members * MEMBER))
