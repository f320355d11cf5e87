"""A run that is asked to end does what it has begun, and begins nothing else.

    SIGTERM, Ctrl-C --> driver --> a file --> every process of this machine looks for it
                                              before an element, and before a table

What is in flight comes to its end and is kept; other elements are let go by, and no
table is written from then on, since some of its rows may be lacking. So the next run
finds all that was made and goes on. A runner of another machine is told to cancel. Who
presses Ctrl-C again does not want to wait: the driver dies of it, its workers with it.
"""

import contextlib
import os
import signal
import tempfile
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Final

VARIABLE: Final = "NOSTALGIN_STOPPING"  # workers inherit it
ASKING: Final = (signal.SIGTERM, signal.SIGINT)
CODES: Final = tuple(128 + one for one in ASKING)  # as a shell tells of their victims


class Stopped(BaseException):
    """Somebody asked to end: nothing that forgives a photo's crash forgives it."""

    def __init__(self, why: str, code: int) -> None:
        """Keep the reason, and the exit code that tells it."""
        super().__init__(why)
        self.code = code


def asked() -> bool:
    """Tell whether somebody asked this run to end."""
    path = os.environ.get(VARIABLE)
    return path is not None and Path(path).exists()


def check() -> None:
    """Go no further if somebody asked to end.

    Raises:
        Stopped: then.
    """
    if asked():
        why = "it was asked to end: what was begun is kept, the next goes on"
        raise Stopped(why, code())


def code() -> int:
    """Tell the exit code of who was asked to end: SIGTERM's, unless it is known."""
    try:
        return int(Path(os.environ[VARIABLE]).read_text())
    except (KeyError, OSError, ValueError):
        return CODES[0]


@contextlib.contextmanager
def heeded(also: Callable[[int], None] = lambda _: None) -> Iterator[None]:
    """Heed SIGTERM and Ctrl-C while a block runs; `also` is told which.

    Elsewhere than in the main thread, and inside another such block, nothing changes.
    """
    if VARIABLE in os.environ or threading.current_thread() is not main():
        yield
        return

    def heard(number: int, _: object) -> None:
        if number == signal.SIGINT and file.exists():
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)
        file.write_text(str(128 + number))
        also(number)

    with tempfile.TemporaryDirectory(prefix="nostalgin-") as folder:
        file = Path(folder) / "stop"
        os.environ[VARIABLE] = str(file)
        before = {one: signal.signal(one, heard) for one in ASKING}
        try:
            yield
        finally:
            for one, handler in before.items():
                signal.signal(one, handler)
            del os.environ[VARIABLE]


@contextlib.contextmanager
def at_once() -> Iterator[None]:
    """End what the main thread waits for elsewhere as soon as somebody asks to.

    Raises:
        Stopped: then.
    """
    if threading.current_thread() is not main():
        yield
        return
    before = {one: signal.getsignal(one) for one in ASKING}

    def heard(number: int, frame: Any) -> None:
        handler = before[signal.Signals(number)]
        if callable(handler):
            handler(number, frame)
        check()

    for one in ASKING:
        signal.signal(one, heard)
    try:
        check()
        yield
    finally:
        for one, handler in before.items():
            signal.signal(one, handler)


def left_to_the_driver() -> None:
    """Let signals pass in a process whose driver hears them, too, and tells it."""
    if VARIABLE in os.environ:
        for one in ASKING:
            signal.signal(one, signal.SIG_IGN)


def main() -> threading.Thread:
    """Name the thread that hears signals."""
    return threading.main_thread()
