"""One run at a time in a city folder, or several shards: a lock that no crash leaves.

CITY/.lock        held by the operating system for as long as its process lives
"""

import contextlib
import errno
import fcntl
import json
import os
import platform
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from pipelines.store.store import Store

LOCK: Final = ".lock"
NO_LOCKS: Final = (errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP, errno.EOPNOTSUPP)


class Busy(RuntimeError):  # noqa: N818 - it reads as what it is about
    """A city folder in which another run is at work."""


@contextlib.contextmanager
def held(store: Store, *, shared: bool = False) -> Iterator[None]:
    """Keep other runs out of a city folder; `shared`, only those that would not share.

    Object stores and file systems that know no locks keep nobody out.

    Raises:
        Busy: if another run is at work there.
        OSError: if the folder can't be written to.
    """
    if "://" in store.root:
        yield
        return
    store.exists(LOCK)  # a folder that can have no name is told before it is made
    path = Path(store.root) / LOCK
    path.parent.mkdir(parents=True, exist_ok=True)
    file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW, 0o666)
    with contextlib.closing(os.fdopen(file, "r+b", buffering=0)) as lock:
        take(file, store, shared=shared)
        lock.truncate(0)
        os.pwrite(file, json.dumps(owner()).encode(), 0)
        try:
            yield
        finally:
            lock.truncate(0)


def take(file: int, store: Store, *, shared: bool) -> None:
    """Take the lock, or tell who has it.

    Raises:
        Busy: if another has it.
    """
    try:
        fcntl.flock(file, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
    except BlockingIOError as problem:
        raise Busy(
            f"{store.root}: another run is at work there{whose(file)}: "
            "wait until it ends, or end it"
        ) from problem
    except OSError as problem:
        if problem.errno not in NO_LOCKS:
            raise


def busy(store: Store) -> str:
    """Tell who has a city folder to itself; "" if nobody has. Shards are not seen."""
    if "://" in store.root:
        return ""
    try:
        file = os.open(Path(store.root) / LOCK, os.O_RDONLY | os.O_CLOEXEC)
    except FileNotFoundError:
        return ""
    try:
        fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return whose(file) or " (nothing tells whose it is)"
    except OSError:
        return ""  # a file system without locks
    finally:
        os.close(file)
    return ""


def owner() -> dict[str, str | int]:
    """Tell who this process is."""
    began = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
    return {"process": os.getpid(), "host": platform.node(), "began": began}


def whose(file: int) -> str:
    """Read who has a lock, if that was written."""
    with contextlib.suppress(ValueError, TypeError, KeyError):
        told = json.loads(os.pread(file, 1000, 0))
        return f" (process {told['process']} on {told['host']} since {told['began']})"
    return ""
