"""A folder that this program writes, and removes from only what it wrote itself.

    SITE/.nostalgin.json        the names of all files that were written, relative

Files that were replaced stay until the next publishing: whoever reads the city that
was there before reads it to its end. The record is written before the files that it
names, so that a publishing which was cut off is known as our own the next time. What it
does not name is a stranger's: it is neither changed nor removed, and where it stands in
the way nothing is written at all.
"""

import contextlib
import glob
import json
import os
from collections.abc import Iterable
from pathlib import Path, PurePosixPath
from typing import Final

from pipelines.store import durable

RECORD: Final = ".nostalgin.json"


class Foreign(ValueError):  # noqa: N818 - it reads as what it is about
    """A folder or a file that another wrote, with what to do about it."""


def written(root: Path) -> frozenset[str]:
    """Read which files in a folder are ours; none where it is missing or empty.

    Raises:
        Foreign: if it is a link or no folder, or holds files but no record of ours.
    """
    if root.is_symlink():
        raise Foreign(f"{root} is a link: remove it, and a folder will be made")
    if not root.exists() or (
        root.is_dir() and not any(map(a_stranger, root.iterdir()))
    ):
        return frozenset()
    now, before = recorded(root)
    return now | before


def recorded(root: Path) -> tuple[frozenset[str], frozenset[str]]:
    """Read which files in a folder are the city, and which the one before it.

    Raises:
        Foreign: if there is no such record.
    """
    nested_deep = RecursionError
    with contextlib.suppress(OSError, ValueError, TypeError, KeyError, nested_deep):
        told = json.loads((root / RECORD).read_bytes())
        now, before = told["now"], told["before"]
        if all(map(inside, [*now, *before])):
            return frozenset(now), frozenset(before)
    raise Foreign(
        f"{root} holds files of which no record says that nostalgin wrote them: "
        "move them elsewhere, and build again"
    )


def a_stranger(path: Path) -> bool:
    """Tell whether a file is more than the first trace of a publishing cut off."""
    return not path.match(partial(RECORD, "*"))


def inside(name: object) -> bool:
    """Tell whether a name is a path that can't lead out of a folder."""
    if not isinstance(name, str) or "\0" in name:
        return False
    path = PurePosixPath(name)
    return bool(path.parts) and not path.is_absolute() and ".." not in path.parts


class Folder:
    """A folder that is written file by file, each whole or not at all."""

    def __init__(self, root: Path, names: Iterable[str]) -> None:
        """Take a folder in which these files, and no others, are to stand.

        Raises:
            Foreign: if it is another's, or another's file or link stands in their way.
        """
        self._root, self._names = root, frozenset(names)
        self._before = written(root)
        known = (root / RECORD).exists()
        self._last = recorded(root)[0] if known else frozenset[str]()
        for name in sorted(self._names):
            self._free(name)
        root.mkdir(parents=True, exist_ok=True)
        self._record(self._last, self._before | self._names)

    def write(self, name: str, data: bytes) -> None:
        """Put a file in its place in one move; one that is already the same stays.

        Raises:
            OSError: if it can't be written there.
            KeyError: if the file was not announced.
        """
        if name not in self._names:
            raise KeyError(name)
        self._put(name, data)

    def prune(self) -> None:
        """Remove what we wrote before the last time, and not since."""
        kept = self._names | self._last
        for name in sorted(self._before | self._names):
            path = self._root / name
            if any(folder.is_symlink() for folder in self._folders(name)):
                continue
            old = [] if name in kept else [path]
            for one in (*old, *path.parent.glob(partial(glob.escape(path.name), "*"))):
                if one.is_file() and not one.is_symlink():
                    one.unlink()
        self._record(self._names, self._last - self._names)

    def _free(self, name: str) -> None:
        for folder in self._folders(name):
            if folder.is_symlink():
                raise Foreign(f"{folder} is a link, it leads out: remove it")
            if folder.exists() and not folder.is_dir():
                raise Foreign(f"{folder} is no folder: move it elsewhere")
        path = self._root / name
        there = path.exists() or path.is_symlink()
        if path.is_dir() or (there and name not in self._before):
            raise Foreign(f"{path} is another's: move it elsewhere, and build again")

    def _folders(self, name: str) -> list[Path]:
        return [self._root / one for one in PurePosixPath(name).parents]

    def _record(self, now: Iterable[str], before: Iterable[str]) -> None:
        told = {"now": sorted(now), "before": sorted(before)}
        self._put(RECORD, json.dumps(told, indent=0).encode())

    def _put(self, name: str, data: bytes) -> None:
        path = self._root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.is_file() and not path.is_symlink() and path.read_bytes() == data:
            return
        beside = path.with_name(partial(path.name, str(os.getpid())))
        beside.unlink(missing_ok=True)
        durable(beside, data)  # never through a link
        beside.replace(path)


def partial(name: str, process: str) -> str:
    """Name the file that is written beside another, and then moved into its place."""
    return f".{name}.{process}.partial"
