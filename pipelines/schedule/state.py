"""Where a schedule stands: what came of the last time, and what is due next."""

from dataclasses import dataclass
from datetime import datetime
from typing import Any

from pipelines.schedule.record import Record
from pipelines.schedule.ticks import NoCron, ticks_after, ticks_between


@dataclass(frozen=True)
class State:
    """Where a schedule stands."""

    last: Record
    overdue: tuple[datetime, ...]  # times that came since, and nobody did anything
    following: datetime | None  # None: nothing tells by what it goes
    made_up: int  # missed times that were made up for, of those on record
    failures: tuple[Record, ...]  # of those on record, the oldest first

    def told(self) -> dict[str, Any]:
        """Give it as plain values."""
        last, next_one = self.last, self.following
        return {
            "cron": last.cron,
            "zone": last.zone,
            "last": vars(last),
            "overdue": [one.isoformat() for one in self.overdue],
            "next": next_one.isoformat() if next_one is not None else None,
            "made_up": self.made_up,
            "failures": [vars(one) for one in self.failures],
        }


def state(records: list[Record], now: datetime) -> State | None:
    """Tell where a schedule stands by its records; None: there never was one."""
    if not records:
        return None
    last = records[-1]
    overdue: list[datetime] = []
    following = None
    try:
        if last.cron:
            overdue = ticks_between(last.cron, last.zone, last.when, now)
            following = next(ticks_after(last.cron, last.zone, now), None)
    except NoCron:  # somebody wrote in the file
        pass
    failures = tuple(one for one in records if one.outcome == "failed")
    made_up = sum(one.missed for one in records)
    return State(last, tuple(overdue), following, made_up, failures)
