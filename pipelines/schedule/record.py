"""What came of each time: the one file that tells a schedule where it was.

CITY/schedule.json      the last times with how they ended, the newest last
"""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from itertools import takewhile
from typing import Final

from pipelines.store import Store

FILE: Final = "schedule.json"
KEPT: Final = 100  # of the last records


@dataclass(frozen=True)
class Record:
    """One time at which something was due, and what came of it."""

    tick: str  # UTC, as 2026-11-22T03:17:00+00:00
    began: str
    ended: str
    outcome: str  # done, nothing, failed, stopped
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


STOPPED: Final = "stopped"  # before it was done: it is due again


def recorded(store: Store) -> list[Record]:
    """Read what came of earlier times; a file that makes no sense tells of none."""
    try:
        told = json.loads(store.read_bytes(FILE))
        found = [Record(**one) for one in told]
        return [one for one in found if one.when]
    except (OSError, ValueError, TypeError):
        return []


def stopped(records: Sequence[Record]) -> list[datetime]:
    """List the times that were stopped since the last other one: they are due again."""
    last = takewhile(lambda one: one.outcome == STOPPED, reversed(records))
    return sorted({one.when for one in last})


def record(store: Store, one: Record) -> None:
    """Add what came of a time."""
    kept = [*recorded(store), one][-KEPT:]
    text = json.dumps([asdict(each) for each in kept], indent=1) + "\n"
    store.write_bytes(FILE, text.encode())
