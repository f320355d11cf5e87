"""What came of each time: the one file that tells a schedule where it was.

CITY/schedule.json      the last times with how they ended, the newest last
"""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from datetime import UTC, datetime
from itertools import takewhile
from typing import Any, Final

from pipelines.store import Store

FILE: Final = "schedule.json"
SPOILED: Final = "schedule.json.spoiled"
KEPT: Final = 100  # of the last records


@dataclass(frozen=True)
class Record:
    """One time at which something was due, and what came of it."""

    tick: str  # UTC, as 2026-11-22T03:17:00+00:00
    began: str
    ended: str
    outcome: str  # done, held, nothing, failed, busy, stopped
    missed: int = 0  # earlier times that this one made up for
    detail: str = ""  # of what failed
    photos: int = 0  # redone
    later: int = 0  # stale ones that the budget left
    run: str = ""  # that was made
    cron: str = ""  # by which it was due
    zone: str = ""

    @property
    def when(self) -> datetime:
        """Give the time that it was due."""
        return datetime.fromisoformat(self.tick).astimezone(UTC)


FIELDS: Final = [one.name for one in fields(Record)]
NEEDED: Final = {"tick", "began", "ended", "outcome"}
COUNTS: Final = ("missed", "photos", "later")
STOPPED: Final = "stopped"  # before it was done: it is due again


def recorded(store: Store) -> list[Record]:
    """Read what came of earlier times; what makes no sense tells of none.

    Raises:
        OSError: if the file is there and can't be read.
    """
    return read(store)[0]


def read(store: Store) -> tuple[list[Record], bytes]:
    """Read the records, and the file's bytes if some of them make no sense."""
    try:
        data = store.read_bytes(FILE)
    except FileNotFoundError:
        return [], b""
    try:
        told = json.loads(data)
    except (ValueError, RecursionError):
        return [], data
    every = [sensible(one) for one in told] if isinstance(told, list) else [None]
    found = [one for one in every if one is not None]
    return found, b"" if len(found) == len(every) else data


def sensible(told: Any) -> Record | None:
    """Take the fields that are known here: a later release may have others.

    None if one is lacking, or is not of its kind.
    """
    if not isinstance(told, dict):
        return None
    known = {name: told[name] for name in FIELDS if name in told}
    kinds = {name: int if name in COUNTS else str for name in known}
    sound = all(type(known[name]) is kind for name, kind in kinds.items())
    whole = sound and known.keys() >= NEEDED and is_time(known["tick"])
    return Record(**known) if whole else None


def is_time(text: str) -> bool:
    """Tell whether a text is a time that has its like in UTC."""
    try:
        datetime.fromisoformat(text).astimezone(UTC)
    except (ValueError, OverflowError):
        return False
    return True


def stopped(records: Sequence[Record]) -> list[datetime]:
    """List the times that were stopped since the last other one: they are due again."""
    last = takewhile(lambda one: one.outcome == STOPPED, reversed(records))
    return sorted({one.when for one in last})


def record(store: Store, one: Record) -> None:
    """Add what came of a time; a file that is spoiled is put aside before."""
    before, spoiled = read(store)
    if spoiled:
        store.write_bytes(SPOILED, spoiled)
    kept = [*before, one][-KEPT:]
    text = json.dumps([asdict(each) for each in kept], indent=1) + "\n"
    store.write_bytes(FILE, text.encode())
