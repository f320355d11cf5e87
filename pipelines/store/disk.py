"""Where a store lies: file systems, and names that they take."""

import errno
import functools
import os
from pathlib import Path
from typing import Final

import pyarrow.fs as pafs

SECRETIVE: Final = (
    "Credentials in the URI, which logs and tables would show: give them by the "
    "environment, or by a file of the cloud's own tools"
)
NOWHERE: Final = frozenset(
    (errno.ENOENT, errno.ENOTDIR, errno.ENAMETOOLONG, errno.ELOOP, errno.EILSEQ)
)


def absent(problem: OSError | ValueError) -> bool:
    """Tell whether a name leads to nothing; else nobody could look what is there."""
    return isinstance(problem, ValueError) or problem.errno in NOWHERE


def textual(name: str) -> bool:
    """Tell whether a file's name is text; a file system takes any bytes."""
    return not any("\ud800" <= letter <= "\udfff" for letter in name)


def durable(path: Path, data: bytes) -> None:
    """Write a new file that is on the disk when this returns.

    Raises:
        FileExistsError: if there is one, or a link.
    """
    with path.open("xb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())


@functools.lru_cache(maxsize=64)
def reached(where: str, process: int) -> tuple[pafs.FileSystem, str]:
    """Find the file system of a path or a URI, once in each process.

    An object store's has connections and threads, which no fork may share.
    """
    del process
    if where.startswith("s3://"):  # what fits into one request is written by one
        where += f"{'&' if '?' in where else '?'}allow_delayed_open=true"
    system, path = pafs.FileSystem.from_uri(where)
    return system, path.rstrip("/")


def secretive(where: str) -> bool:
    """Tell whether a URI gives credentials away to whoever reads it."""
    return "://" in where and "@" in where.partition("://")[2].partition("/")[0]
