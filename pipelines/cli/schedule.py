"""`nostalgin schedule`: a city is reprocessed at set times."""

import threading
from datetime import UTC, datetime
from functools import partial
from typing import TYPE_CHECKING, Annotated, Final

import typer

from pipelines import stopping
from pipelines.cli.launch import TOO_MANY_REJECTIONS, City, JsonLines, ModelsFolder
from pipelines.cli.reprocess import redone
from pipelines.console import Quiet, Voice, errors, fail, unwritable

if TYPE_CHECKING:
    from pipelines.schedule import Record, Schedule
    from pipelines.store import Store

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

    def end(self, _: int) -> None:
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

    insisted(Store(city))
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
    try:
        with stopping.heeded(clock.end):
            if not once:
                schedule.run_on(timed, clock, work)
            elif not schedule.run_due(timed, clock, work, None):
                waited(timed, clock.now(), voice)
    except OSError as problem:
        raise unwritable(city, problem) from problem
    if once or set(outcomes[-1:]) & set(stopping.CODES):
        raise typer.Exit(outcomes[-1] if outcomes else 0)


def insisted(store: "Store") -> None:
    """Insist on a city that there is something to do in, before a file is written.

    Raises:
        Exit: if there is no manifest.
    """
    from pipelines.index.row import CSV
    from pipelines.index.source import PARQUET

    try:
        there = any(store.exists(name) for name in (CSV, PARQUET))
    except OSError as problem:
        raise unwritable(store.root, problem) from problem
    if not there:
        raise fail(f"{store.root} has no {PARQUET}: run `nostalgin index` first")


def waited(schedule: "Schedule", now: datetime, voice: Voice) -> None:
    """Tell when something is due next, where nothing is."""
    from pipelines.schedule import following

    when = following(schedule, now).isoformat(timespec="minutes")
    voice.say("next", f"nothing is due: the next time is {when}", next=when)


def reprocessed(
    given: tuple[str, Voice, str, list[str]], budget: int, outcomes: list[int]
) -> "Record":
    """Reprocess once, add its exit code to `outcomes`, and record what came of it.

    Whatever a run ends with is recorded here, so that the next time goes on.

    Raises:
        BadParameter: if its options make no sense: no later time could do better.
    """
    from pipelines.schedule import Record

    try:
        done = redone(*given, budget=budget)
    except typer.Exit as problem:
        outcomes.append(problem.exit_code)
        words = str(problem.__cause__ or f"exit code {problem.exit_code}")
        return Record("", "", "", ended(problem), detail=words[:MOST_WORDS])
    except typer.BadParameter:
        raise
    except Exception as problem:  # noqa: BLE001 - the next time goes on
        words = f"{type(problem).__name__}: {problem}"
        outcomes.append(fail(words).exit_code)
        return Record("", "", "", "failed", detail=words[:MOST_WORDS])
    report = done.report
    held = report is not None and report.held
    outcomes.append(TOO_MANY_REJECTIONS if held else 0)
    outcome = "held" if held else "nothing" if report is None else "done"
    photos, later = done.plan.photos, done.plan.later
    run = report.run if report is not None else ""
    return Record("", "", "", outcome, photos=photos, later=later, run=run)


def ended(problem: typer.Exit) -> str:
    """Tell in a word what a run ended with that told so itself."""
    from pipelines.store import Busy

    if isinstance(problem.__cause__, Busy):
        return "busy"
    return "stopped" if problem.exit_code in stopping.CODES else "failed"
