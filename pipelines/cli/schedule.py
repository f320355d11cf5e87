"""`nostalgin schedule`: a city is reprocessed at set times."""

import threading
from datetime import UTC, datetime
from functools import partial
from typing import TYPE_CHECKING, Annotated, Final

import typer

from pipelines import stopping
from pipelines.cli.launch import City, JsonLines, ModelsFolder
from pipelines.cli.reprocess import redone
from pipelines.console import Quiet, Voice, errors

if TYPE_CHECKING:
    from pipelines.schedule import Record

EXAMPLES: Final = """
Examples:

  nostalgin schedule city --cron "17 3 * * *" --zone Europe/Berlin

  nostalgin schedule city --cron "17 3 * * *" --once   [dim]# by another's timer[/]
"""
MOST_WORDS: Final = 500  # letters of what failed, in the record


class Wall:
    """The machine's clock, which a signal ends."""

    def __init__(self) -> None:
        """Begin to wait."""
        self._ended = threading.Event()

    def now(self) -> datetime:
        """Tell the time."""
        return datetime.now(UTC)

    def sleep(self, seconds: float) -> None:
        """Wait, but no longer than until somebody asks to end."""
        self._ended.wait(seconds)

    def stopped(self) -> bool:
        """Tell whether somebody asked to end."""
        return self._ended.is_set()

    def end(self) -> None:
        """Ask to end."""
        self._ended.set()


def schedule_command(
    context: typer.Context,
    city: City,
    *,
    cron: Annotated[str, typer.Option(help='When, as "17 3 * * *".')],
    zone: Annotated[str, typer.Option(help="The time zone of it.")] = "UTC",
    once: Annotated[
        bool, typer.Option("--once", help="Do what is due, and end; for timers.")
    ] = False,
    budget: Annotated[
        int, typer.Option(min=0, help="Photographs at most, each time.")
    ] = 0,
    jitter: Annotated[
        float, typer.Option(min=0, help="Start at most so many seconds later.")
    ] = 0,
    models: ModelsFolder = None,
    json_lines: JsonLines = False,
    quiet: Quiet = False,
) -> None:
    """Reprocess a city at set times; what was missed is made up for once.

    What came of each time is kept in CITY/schedule.json. After SIGTERM what is in
    flight comes to its end and nothing else begins; the next goes on where it was.
    """
    from pipelines import schedule
    from pipelines.store import Store

    voice = Voice(errors, machine=json_lines, quiet=quiet)
    outcomes: list[int] = []
    given = (city, voice, str(models or ""), context.args)
    work = partial(reprocessed, given, budget, outcomes)
    clock = Wall()
    timed = schedule.Schedule(Store(city), cron, zone, jitter)
    try:
        schedule.ticks_between(cron, zone, clock.now(), clock.now())
    except schedule.NoCron as problem:
        raise typer.BadParameter(str(problem)) from problem
    with stopping.heeded(clock.end):
        if once:
            schedule.run_due(timed, clock, work, None)
        else:
            schedule.run_on(timed, clock, work)
    if once or stopping.CODE in outcomes[-1:]:
        raise typer.Exit(outcomes[-1] if outcomes else 0)


def reprocessed(
    given: tuple[str, Voice, str, list[str]], budget: int, outcomes: list[int]
) -> "Record":
    """Reprocess once, add its exit code to `outcomes`, and record what came of it."""
    from pipelines.schedule import Record

    try:
        done = redone(*given, budget=budget)
    except typer.Exit as problem:
        outcomes.append(problem.exit_code)
        words = str(problem.__cause__ or f"exit code {problem.exit_code}")
        stopped = problem.exit_code == stopping.CODE
        outcome = "stopped" if stopped else "failed"
        return Record("", "", "", outcome, detail=words[:MOST_WORDS])
    outcomes.append(0)
    outcome = "nothing" if done.report is None else "done"
    photos, later = done.plan.photos, done.plan.later
    run = done.report.run if done.report is not None else ""
    return Record("", "", "", outcome, photos=photos, later=later, run=run)
