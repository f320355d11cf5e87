"""Work that is done at set times, each missed time made up for once.

In: a cron expression, a clock, and what to do. Out: a record of what came of each.
Open `ticks` first, then `schedule`.
"""

from pipelines.schedule.record import Record, recorded
from pipelines.schedule.schedule import Schedule, following, run_due, run_on
from pipelines.schedule.state import State, state
from pipelines.schedule.ticks import NoCron, ticks_between

__all__ = [
    "NoCron",
    "Record",
    "Schedule",
    "State",
    "following",
    "recorded",
    "run_due",
    "run_on",
    "state",
    "ticks_between",
]
