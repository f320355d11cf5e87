"""The times that a cron expression names, in a time zone.

Daylight saving is as Debian's cron has it: a time of day that the clocks skip is made
up for at once, and one that they show twice is taken once; what runs every so many
minutes or hours goes on by elapsed time.
"""

from collections.abc import Iterator
from datetime import UTC, datetime
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

from cronsim import CronSim, CronSimError


class NoCron(ValueError):  # noqa: N818 - it reads as what it is about
    """A cron expression or a time zone that is none."""


def ticks_after(cron: str, zone: str, when: datetime) -> Iterator[datetime]:
    """List the times after another, in UTC.

    Raises:
        NoCron: if the expression names no times, or there is no such zone.
    """
    try:
        local = when.astimezone(ZoneInfo(zone))
        for tick in CronSim(cron, local):
            yield tick.astimezone(UTC)
    except (ZoneInfoNotFoundError, IsADirectoryError, ValueError) as problem:
        raise NoCron(
            f"{zone!r} is no time zone: write it as Europe/Berlin"
        ) from problem
    except CronSimError as problem:
        words = f"{cron!r} is no cron expression ({problem}): write it as '17 3 * * *'"
        raise NoCron(words) from problem


def ticks_between(
    cron: str, zone: str, after: datetime, until: datetime
) -> list[datetime]:
    """List the times after one and up to another, in UTC.

    Raises:
        NoCron: if the expression names no times, or there is no such zone.
    """
    found: list[datetime] = []
    for tick in ticks_after(cron, zone, after):
        if tick > until:
            break
        found.append(tick)
    return found
