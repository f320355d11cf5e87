"""Rows by the million point at nothing that points back: circles are sought seldom."""

import contextlib
import gc
from collections.abc import Iterator
from typing import Final

SELDOM: Final = (50_000, 20, 100)  # objects, then sweeps; Python's own are 700, 10, 10


@contextlib.contextmanager
def seldom() -> Iterator[None]:
    """Let Python seek circles of objects seldom, which takes a quarter of the time.

    Whatever no circle holds is let go of at once, as ever.
    """
    before = gc.get_threshold()
    gc.set_threshold(*SELDOM)
    try:
        yield
    finally:
        gc.set_threshold(*before)
