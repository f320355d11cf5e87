"""What an archive's file names and boards are like: a small TOML file, a profile.

`docs/placards.md` describes it, and has an example. Those that come with the program
lie in `archives/`.
"""

import tomllib
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Final

from nostalgin_core.catalogue import Naming
from pipelines import bounded
from pipelines.index import watermarks
from pipelines.index.images import Nothing
from pipelines.store import Store

ARCHIVES: Final = Path(__file__).with_name("archives")
USUAL: Final = "nyc-1940"
PROFILE: Final = "profile.toml"  # in a city folder: the one that it was indexed with

Beside = Callable[[str], bytes]  # reads a file that a profile names


@dataclass(frozen=True)
class Profile:
    """How an archive names its files, and what its boards are like."""

    name: str
    naming: Naming
    boarded: bool  # its photographs show boards
    board: str = ""  # a pattern of theirs; empty: of New York's
    watermark: str = ""  # that its copies bear, by name; empty: none is taken out
    own_mark: bytes = b""  # the file of one that the archive learnt itself
    toml: bytes = b""  # as it was read

    @property
    def mark(self) -> bytes:
        """Give the file of the watermark that copies bear; nothing of none."""
        return self.own_mark or watermarks.content(self.watermark)


def profile(asked: str) -> Profile:
    """Load a profile: one that comes with the program by its name, or a file.

    Raises:
        Nothing: if there is none, or it makes no sense; with file, key and remedy.
    """
    if asked in built_in():
        return shipped(asked)
    return read(Path(asked))


def built_in() -> list[str]:
    """Name the profiles that come with the program."""
    return sorted(one.stem for one in ARCHIVES.glob("*.toml"))


@lru_cache
def shipped(name: str) -> Profile:
    """Load a profile that comes with the program."""
    return read(ARCHIVES / f"{name}.toml")


def read(path: Path) -> Profile:
    """Read a profile's file.

    Raises:
        Nothing: if it can't be read, or makes no sense.
    """
    try:
        data = bounded.read(path, bounded.PROFILE_BYTES)
    except (OSError, ValueError) as problem:  # a name may hold a NUL
        why = getattr(problem, "strerror", None) or problem
        known = ", ".join(built_in())
        raise Nothing(
            f"{path}: {why}; name a TOML file, or one of {known}"
        ) from problem
    return parsed(data, path, beside(path))


def beside(path: Path) -> Beside:
    """Read files that lie beside a profile."""
    return lambda name: bounded.read(path.parent / name, bounded.MARK_BYTES)


def of_city(store: Store) -> Profile:
    """Load what a city was indexed with; New York's where nothing tells it.

    Raises:
        Nothing: if what is kept makes no sense.
        OSError: if it can't be read.
    """
    if not store.exists(PROFILE):
        return shipped(USUAL)
    data = store.read_bytes(PROFILE, bounded.PROFILE_BYTES)
    return parsed(data, Path(PROFILE), lambda _: kept_mark(store))


def kept_mark(store: Store) -> bytes:
    """Read the archive's own watermark, as `index` kept it in a city folder."""
    return store.read_bytes(watermarks.OWN, bounded.MARK_BYTES)


def parsed(data: bytes, path: Path, held: Beside) -> Profile:
    """Read a profile's bytes.

    Raises:
        Nothing: if they make no sense; the path is named.
    """
    try:
        cells = tomllib.loads(data.decode("utf-8-sig"))
    except UnicodeDecodeError as problem:
        raise Nothing(f"{path}: not UTF-8; save it as UTF-8") from problem
    except (ValueError, RecursionError) as problem:
        why = str(problem)[:200]
        raise Nothing(f"{path}: no TOML: {why}; mend that line") from problem
    from pipelines.index.patterns import (
        of_cells,
    )  # slow to load, and a worker needs none

    return replace(of_cells(cells, path, held), toml=data)
