"""A schedule goes from one time to the next, and makes up for those it missed once."""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from typing import Final, Protocol

from pipelines.schedule.record import Record, record, recorded, stopped
from pipelines.schedule.ticks import ticks_after, ticks_between
from pipelines.store import Store

NAP_S: Final = 30.0  # a machine that slept is noticed after this

Work = Callable[[], Record]  # with its outcome; the times are filled in


class Clock(Protocol):
    """What tells the time, and waits."""

    def now(self) -> datetime:
        """Tell the time in UTC."""
        ...

    def sleep(self, seconds: float) -> None:
        """Wait."""
        ...

    def stopped(self) -> bool:
        """Tell whether somebody asked to end."""
        ...


@dataclass(frozen=True)
class Schedule:
    """When something is to be done in a city folder."""

    store: Store
    cron: str
    zone: str = "UTC"
    jitter_s: float = 0.0  # at most so much later

    def delay(self, tick: datetime) -> timedelta:
        """Tell by how much a time is put off: drawn from the city and the time."""
        told = f"{self.store.root}\0{tick.isoformat()}".encode()
        share = int.from_bytes(hashlib.sha256(told).digest()[:4], "big") / 2**32
        return timedelta(seconds=share * self.jitter_s)

    def due(self, now: datetime, since: datetime) -> list[datetime]:
        """List the times that have come since another, and were put off no longer."""
        ticks = ticks_between(self.cron, self.zone, since, now)
        return [tick for tick in ticks if tick + self.delay(tick) <= now]


def following(schedule: Schedule, since: datetime) -> datetime:
    """Tell when something is due next: after the last record, or since a time.

    Raises:
        NoCron: if the expression names no times, or there is no such zone.
    """
    before = recorded(schedule.store)
    last = before[-1].when if before else since
    tick = next(ticks_after(schedule.cron, schedule.zone, last))
    return tick + schedule.delay(tick)


def run_due(
    schedule: Schedule, clock: Clock, work: Work, since: datetime | None
) -> bool:
    """Do what is due since a time, once for all that were missed; tell whether it was.

    Without a time before, it is due.
    """
    before = recorded(schedule.store)
    last = before[-1].when if before else since
    now = clock.now()
    ticks = [now] if last is None else schedule.due(now, last)
    ticks = [*stopped(before), *ticks]
    if not ticks:
        return False
    began = now.astimezone(UTC)
    made = work()
    told = {"tick": ticks[-1].isoformat(), "began": began.isoformat()}
    ended = clock.now().astimezone(UTC).isoformat()
    told |= {"ended": ended, "cron": schedule.cron, "zone": schedule.zone}
    done = replace(made, **told, missed=len(ticks) - 1)
    record(schedule.store, done)
    return True


def run_on(schedule: Schedule, clock: Clock, work: Work) -> None:
    """Go from time to time until somebody asks to end.

    Raises:
        NoCron: if the expression names no times, or there is no such zone.
    """
    since = clock.now()
    while not clock.stopped():
        if run_due(schedule, clock, work, since):
            continue
        wait = following(schedule, since) - clock.now()
        clock.sleep(min(max(wait.total_seconds(), 0.0), NAP_S))
