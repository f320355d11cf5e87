"""Keep the chatter of a runner and its workers away, unless something fails."""

import contextlib
import logging
import os
import sys
import tempfile
from collections.abc import Iterator
from typing import Final, TextIO

from rich.console import Console

TAIL: Final = 4000  # characters of chatter that explain a failure


@contextlib.contextmanager
def hushed(
    console: Console, *, plain: tuple[type[BaseException], ...] = ()
) -> Iterator[None]:
    """Catch what is written to standard error by others, workers' processes included.

    `console` goes on speaking. If the code inside fails, the end of what was caught is
    told after all, unless the failure is a `plain` one, that tells all by itself.
    """
    logging.getLogger().setLevel(logging.ERROR)
    try:
        own = os.dup(sys.stderr.fileno())
    except OSError:  # there is no real standard error, as under a test runner
        yield
        return
    before = console.file
    with (
        tempfile.TemporaryFile("w+", errors="replace") as caught,
        os.fdopen(own, "w", buffering=1) as voice,
    ):
        console.file = voice
        os.dup2(caught.fileno(), sys.stderr.fileno())
        try:
            yield
        except plain:
            raise
        except BaseException:
            voice.write(tail(caught))
            raise
        finally:
            os.dup2(voice.fileno(), sys.stderr.fileno())
            console.file = before


def tail(caught: TextIO) -> str:
    """Read the end of what was caught."""
    caught.flush()
    caught.seek(0)
    return caught.read()[-TAIL:]
