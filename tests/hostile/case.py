"""A command is given something hostile, and what must come out of it."""

import contextlib
import hashlib
import os
import re
import resource
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import pytest
from typer.testing import CliRunner

from pipelines.cli import app
from pipelines.index import manifest
from pipelines.store import Store
from tests.hostile.still_open import OPEN

MOST_BYTES: Final = 1024**3  # that a command may take for what it reads
LEFT: Final = {"city", "city/.lock"}  # of an output that nothing was written to
MOST_LETTERS: Final = 1_000_000  # of what is told, however long the input's words
HANG_S: Final = 20  # in which each answers; it is a guard, no measure
BUILD_S: Final = 240  # in which a whole build does

Make = Callable[[Path], Sequence[object]]


@dataclass(frozen=True)
class Case:
    """One hostile input; `make` writes it into a folder and gives the command."""

    name: str
    make: Make
    code: int
    says: tuple[str, ...] = ()  # what is wrong with what, and how to mend it
    writes: str | None = None  # below which all lies that is written; None: nothing is
    keeps: tuple[str, ...] = ()  # photographs that its manifest names all the same


def check(case: Case, folder: Path) -> None:
    """Run a case's command in a folder, and compare all that comes out.

    Raises:
        AssertionError: if anything else comes out.
    """
    words = [str(word) for word in case.make(folder)]
    before = tree(folder)
    with contextlib.chdir(folder), bounded():
        result = CliRunner().invoke(app, words)
    told = result.output
    if result.exception and not isinstance(result.exception, SystemExit):
        raise AssertionError(f"{result.exception!r} was raised") from result.exception
    assert result.exit_code == case.code, told
    assert "Traceback" not in told
    assert len(told) < MOST_LETTERS
    for said in case.says:
        assert bare(said) in bare(told), told
    changed = {name for name, _ in before.items() ^ tree(folder).items()}
    left = LEFT - before.keys()
    outside = {name for name in changed - left if not below(name, case.writes)}
    assert not outside
    if case.keeps:
        assert set(case.keeps) <= shown(folder / str(case.writes))


def shown(city: Path) -> set[str]:
    """List the photographs that a city's manifest names."""
    return {row.photo for row in manifest.read(Store(str(city))).rows}


def bare(text: str) -> str:
    """Leave out blanks, line breaks and the frame that wrong usage is told in."""
    return re.sub(r"[\s\u2500-\u257f]+", "", text)


def below(name: str, folder: str | None) -> bool:
    return folder is not None and Path(name).is_relative_to(folder)


def tree(folder: Path) -> dict[str, str]:
    """Tell what is in a folder, following no link: kinds, links, hashes of files."""
    return {
        path.relative_to(folder).as_posix(): kind(path)
        for path in walked(os.fsencode(folder))
    }


def walked(folder: bytes) -> Iterator[Path]:
    """List all that is below a folder, but for what lies deeper than a path is long."""
    waiting = [folder]
    while waiting:
        with contextlib.suppress(OSError), os.scandir(waiting.pop()) as entries:
            for entry in entries:
                if os.path.lexists(entry.path):
                    yield Path(os.fsdecode(entry.path))
                if entry.is_dir(follow_symlinks=False):
                    waiting.append(entry.path)


def kind(path: Path) -> str:
    if path.is_symlink():
        return f"link to {path.readlink()}"
    if not path.is_file():
        return "folder" if path.is_dir() else "device"
    if path.stat().st_size > 10**8:  # made of holes
        return f"{path.stat().st_size} bytes"
    return hashlib.sha256(path.read_bytes()).hexdigest()


@contextlib.contextmanager
def bounded(most: int = MOST_BYTES) -> Iterator[None]:
    """Let this process ask for no more memory than it has and so much beside."""
    if not sys.platform.startswith("linux"):
        yield
        return
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    limit = pages * resource.getpagesize() + most
    resource.setrlimit(resource.RLIMIT_AS, (limit, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


def parameters(kind: str, cases: Sequence[Any], *, within_s: float = HANG_S) -> list:
    """Give cases to pytest, those that are still open as failures to be expected."""
    return [
        pytest.param(one, id=called(one), marks=marks(kind, called(one), within_s))
        for one in cases
    ]


def called(one: Any) -> str:
    return getattr(one, "called", None) or one.name


def marks(kind: str, name: str, within_s: float) -> list[pytest.MarkDecorator]:
    """Guard a case against hanging, and expect it to fail while it is open."""
    guard = pytest.mark.timeout(within_s)
    why = OPEN.get(f"{kind}: {name}")
    if why is None:
        return [guard]
    why += " (if it passes it is no longer open: take it off the list)"
    return [guard, pytest.mark.xfail(reason=why, strict=True)]
