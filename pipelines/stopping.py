"""A run that is asked to end does what it has begun, and begins nothing else.

    SIGTERM --> driver --> a file --> every process of this machine looks for it before
                                      an element, and before a table

What is in flight comes to its end and is kept; other elements are let go by, and no
table is written from then on, since some of its rows may be lacking. So the next run
finds all that was made and goes on. A runner of another machine is told to cancel.
"""

import contextlib
import os
import signal
import tempfile
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Final

VARIABLE: Final = "NOSTALGIN_STOPPING"  # workers inherit it
CODE: Final = 128 + signal.SIGTERM  # as a shell tells of a process that SIGTERM ended


class Stopped(BaseException):
    """Somebody asked to end: nothing that forgives a photo's crash forgives it."""


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
        raise Stopped("it was asked to end: what was begun is kept, the next goes on")


@contextlib.contextmanager
def heeded(also: Callable[[], None] = lambda: None) -> Iterator[None]:
    """Heed SIGTERM while a block of code runs; `also` is called when it comes.

    Elsewhere than in the main thread, and inside another such block, nothing changes.
    """
    if VARIABLE in os.environ or threading.current_thread() is not main():
        yield
        return

    def heard(*_: object) -> None:
        file.touch()
        also()

    with tempfile.TemporaryDirectory(prefix="nostalgin-") as folder:
        file = Path(folder) / "stop"
        os.environ[VARIABLE] = str(file)
        before = signal.signal(signal.SIGTERM, heard)
        try:
            yield
        finally:
            signal.signal(signal.SIGTERM, before)
            del os.environ[VARIABLE]


@contextlib.contextmanager
def at_once() -> Iterator[None]:
    """End what the main thread waits for elsewhere as soon as SIGTERM comes.

    Raises:
        Stopped: then.
    """
    if threading.current_thread() is not main():
        yield
        return
    before = signal.getsignal(signal.SIGTERM)

    def heard(number: int, frame: object) -> None:
        if callable(before):
            before(number, frame)  # type: ignore[arg-type] - as it was given to us
        check()

    signal.signal(signal.SIGTERM, heard)
    try:
        check()
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def left_to_the_driver() -> None:
    """Let SIGTERM pass in a process whose driver hears it, too, and tells it to end."""
    if VARIABLE in os.environ:
        signal.signal(signal.SIGTERM, signal.SIG_IGN)


def main() -> threading.Thread:
    """Name the thread that hears signals."""
    return threading.main_thread()
