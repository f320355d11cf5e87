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
from collections.abc import Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from itertools import chain
from pathlib import Path, PurePosixPath
from typing import BinaryIO, Final

from pipelines.site.growing import growing, partial

RECORD: Final = ".nostalgin.json"
NOW, LAST, EARLIER = 1, 2, 4  # to be written; written the last time; the time before


class Foreign(ValueError):  # noqa: N818 - it reads as what it is about
    """A folder or a file that another wrote, with what to do about it."""


def written(root: Path) -> frozenset[str]:
    """Read which files in a folder are ours; none where it is missing or empty.

    Raises:
        Foreign: if it is a link or no folder, or holds files but no record of ours.
    """
    now, before = ours(root)
    return frozenset(now).union(before)


def ours(root: Path) -> tuple[list[str], list[str]]:
    """Read a folder's record, empty where the folder is missing or empty.

    Raises:
        Foreign: as `written`.
    """
    if root.is_symlink():
        raise Foreign(f"{root} is a link: remove it, and a folder will be made")
    if not root.exists() or (
        root.is_dir() and not any(map(a_stranger, root.iterdir()))
    ):
        return [], []
    return told(root)


def recorded(root: Path) -> tuple[frozenset[str], frozenset[str]]:
    """Read which files in a folder are the city, and which the one before it.

    Raises:
        Foreign: if there is no such record.
    """
    now, before = told(root)
    return frozenset(now), frozenset(before)


def told(root: Path) -> tuple[list[str], list[str]]:
    """Read the two lists of a record.

    Raises:
        Foreign: if there is no such record.
    """
    nested_deep = RecursionError
    with contextlib.suppress(OSError, ValueError, TypeError, KeyError, nested_deep):
        both = json.loads((root / RECORD).read_text(encoding="utf-8"))
        now, before = both["now"], both["before"]
        if all(map(inside, chain(now, before))):
            return list(now), list(before)
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
    """A folder that is written file by file, each whole or not at all.

    Each name is held once, with what is known of its file (`NOW`, `LAST`, `EARLIER`).
    """

    def __init__(self, root: Path, names: Iterable[str]) -> None:
        """Take a folder in which these files, and no others, are to stand.

        Raises:
            Foreign: if it is another's, or another's file or link stands in their way.
        """
        self._root = root
        self._known = dict.fromkeys(names, NOW)
        for each, mark in zip(ours(root), (LAST, EARLIER), strict=True):
            for name in each:
                self._known[name] = self._known.get(name, 0) | mark
        for name in self._of(NOW):
            self._free(name)
        root.mkdir(parents=True, exist_ok=True)
        self._record(self._of(LAST), self._of(NOW | LAST | EARLIER))

    def write(self, name: str, data: bytes) -> None:
        """Put a file in its place in one move; one that is already the same stays.

        Raises:
            OSError: if it can't be written there.
            KeyError: if the file was not announced.
        """
        path = self._announced(name)
        if path.is_file() and not path.is_symlink() and path.read_bytes() == data:
            return
        with growing(path) as file:
            file.write(data)

    def growing(self, name: str) -> AbstractContextManager[BinaryIO]:
        """Write a file bit by bit, and put it in its place as `write` does.

        Raises:
            OSError, KeyError: as `write`.
        """
        return growing(self._announced(name))

    def prune(self) -> None:
        """Remove what we wrote before the last time, and not since."""
        for name in self._of(NOW | LAST | EARLIER):
            path = self._root / name
            if any(folder.is_symlink() for folder in self._folders(name)):
                continue
            old = [] if self._known[name] & (NOW | LAST) else [path]
            for one in (*old, *path.parent.glob(partial(glob.escape(path.name), "*"))):
                if one.is_file() and not one.is_symlink():
                    one.unlink()
        self._record(self._of(NOW), self._of(LAST, without=NOW))

    def _of(self, marks: int, *, without: int = 0) -> list[str]:
        known = self._known.items()
        return sorted(n for n, mark in known if mark & marks and not mark & without)

    def _announced(self, name: str) -> Path:
        if not self._known.get(name, 0) & NOW:
            raise KeyError(name)
        return self._root / name

    def _free(self, name: str) -> None:
        for folder in self._folders(name):
            if folder.is_symlink():
                raise Foreign(f"{folder} is a link, it leads out: remove it")
            if folder.exists() and not folder.is_dir():
                raise Foreign(f"{folder} is no folder: move it elsewhere")
        path = self._root / name
        there = path.exists() or path.is_symlink()
        if path.is_dir() or (there and self._known[name] == NOW):
            raise Foreign(f"{path} is another's: move it elsewhere, and build again")

    def _folders(self, name: str) -> list[Path]:
        return [self._root / one for one in PurePosixPath(name).parents]

    def _record(self, now: Sequence[str], before: Sequence[str]) -> None:
        with growing(self._root / RECORD) as file:
            file.writelines(line.encode() for line in lines(now, before))


def lines(now: Sequence[str], before: Sequence[str]) -> Iterator[str]:
    """Write a record as JSON, a line a name."""
    for key, names, first, last in (
        ("now", now, "{", ","),
        ("before", before, "", "}"),
    ):
        yield f'{first}\n"{key}": ['
        for number, name in enumerate(names):
            yield f"{',' if number else ''}\n{json.dumps(name)}"
        yield "\n]" if names else "]"
        yield last if last == "," else f"\n{last}"
