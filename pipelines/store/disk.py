"""Where a store lies: file systems, and names that they take."""

import contextlib
import errno
import functools
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import pyarrow as pa
import pyarrow.fs as pafs

SECRETIVE: Final = (
    "Credentials in the URI, which logs and tables would show: give them by the "
    "environment, or by a file of the cloud's own tools"
)
STRANGER: Final = (
    "give credentials by GOOGLE_APPLICATION_CREDENTIALS, or by "
    "`gcloud auth application-default login`"
)
GOOGLE: Final = "google::cloud::Status"
FIRST_S: Final = 5  # for Google's servers to answer at first; later Arrow's 900
NOWHERE: Final = frozenset(
    (errno.ENOENT, errno.ENOTDIR, errno.ENAMETOOLONG, errno.ELOOP, errno.EILSEQ)
)


class Unstored(BaseException):
    """What was made can't be put where it belongs; no photo's fault, it ends the run.

    It is no `Exception`, so that nothing that forgives a photo's crash forgives it.
    """


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
    if where.startswith("gs://") and "retry_limit_seconds" not in where:
        soon = f"{where}{'&' if '?' in where else '?'}retry_limit_seconds={FIRST_S}"
        with worded():
            pafs.FileSystem.from_uri(soon)[0].get_file_info(path)
    return system, path.rstrip("/")


@contextlib.contextmanager
def worded() -> Iterator[None]:
    """Tell what Google's client says of no file as file systems do.

    Raises:
        OSError: with number and words, where Arrow has neither.
    """
    try:
        yield
    except (OSError, pa.ArrowException) as problem:
        named = isinstance(problem, OSError) and problem.errno is not None
        if named or GOOGLE not in str(problem):
            raise
        raise OSError(errno.EIO, in_short(str(problem))) from problem


def in_short(said: str) -> str:
    """Shorten what Google's client says to what went wrong, and add the remedy."""
    why = said.removeprefix("Unknown error: ").partition(" error_info=")[0]
    why = why.rpartition("error message was: ")[2].rpartition("last message of ")[2]
    remedy = STRANGER if "credential" in said or "OAuth2" in said else "try again"
    return f"{why.strip().rstrip('.')}; {remedy}"


def secretive(where: str) -> bool:
    """Tell whether a URI gives credentials away to whoever reads it."""
    return "://" in where and "@" in where.partition("://")[2].partition("/")[0]


def drop_tree(system: pafs.FileSystem, path: str) -> None:
    """Remove a folder with all that is in it, if it is there.

    Of an object store the objects are removed: it knows no folder, or says that it has
    none of that name where there are objects below.
    """
    if isinstance(system, pafs.LocalFileSystem):
        with contextlib.suppress(FileNotFoundError):
            system.delete_dir(path)
        return
    at = pafs.FileSelector(path, allow_not_found=True, recursive=True)
    for one in system.get_file_info(at):
        if one.is_file:
            system.delete_file(one.path)
