"""A file that grows beside its place, and is put there whole or not at all.

    SITE/.NAME.PROCESS.partial      what there is of it so far

So no more of it is held than what is written at a time.
"""

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, Final

CHUNK: Final = 1 << 20  # bytes that are compared at a time


@contextlib.contextmanager
def growing(path: Path) -> Iterator[BinaryIO]:
    """Write a file bit by bit; one that is already the same stays.

    If the block of code ends by an error, what was there before stays, too.

    Raises:
        OSError: if it can't be written there.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_name(partial(path.name, str(os.getpid())))
    beside.unlink(missing_ok=True)
    try:
        with beside.open("xb") as file:  # never through a link
            yield file
            file.flush()
            if path.is_file() and not path.is_symlink() and alike(beside, path):
                return
            os.fsync(file.fileno())
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


def alike(a: Path, b: Path) -> bool:
    """Tell whether two files hold the same bytes."""
    if a.stat().st_size != b.stat().st_size:
        return False
    with a.open("rb") as one, b.open("rb") as other:
        while data := one.read(CHUNK):
            if data != other.read(CHUNK):
                return False
    return True


def partial(name: str, process: str) -> str:
    """Name the file that is written beside another, and then moved into its place."""
    return f".{name}.{process}.partial"
