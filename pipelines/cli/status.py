"""`nostalgin status`: a city's runs and its schedule, and what of it is stale."""

import json
from collections.abc import Iterator
from dataclasses import asdict, replace
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Annotated, Final

import typer

from pipelines import plural
from pipelines.cli.launch import City, JsonLines, ModelsFolder
from pipelines.cli.reprocess import lines, looked
from pipelines.console import Quiet, Voice, errors, unreadable

if TYPE_CHECKING:
    from pipelines.report import Past
    from pipelines.schedule import State

EXAMPLES: Final = """
Examples:

  nostalgin status city

  nostalgin status city --brief          [dim]# without looking what is stale[/]

  nostalgin status city --json
"""
MOST: Final = 5  # failures that people are told; --json tells all on record
DAY: Final = "%Y-%m-%d %H:%M"
UNBUILT: Final = "nothing was built there yet; run `nostalgin build`"


def status_command(
    city: City,
    *,
    brief: Annotated[
        bool, typer.Option("--brief", help="Leave out what is stale: it takes a look.")
    ] = False,
    models: ModelsFolder = None,
    json_lines: JsonLines = False,
    quiet: Quiet = False,
) -> None:
    """Tell a city's runs, how its schedule stands, what failed, and what is stale."""
    from pipelines import report, schedule
    from pipelines.store import Store, busy

    store = Store(city)
    try:
        pasts, at_work = report.history(store), busy(store)
        records = schedule.recorded(store)
    except OSError as problem:
        raise unreadable(city, problem) from problem
    voice = Voice(errors, machine=json_lines, quiet=quiet)
    now = schedule.state(records, datetime.now(UTC))
    if json_lines:
        told = [asdict(one) | {"state": one.state} for one in pasts]
        told += [{"schedule": now.told()}] if now is not None else []
        said = [json.dumps(one) for one in told]
    else:
        said = [*map(row, pasts), *(timed(now) if now is not None else ())]
        said += [] if pasts else [f"{city}: {UNBUILT}"]
        said += [f"a run is at work there{at_work}"] if at_work else []
    for line in said:
        voice.echo(line)
    if any(one.current for one in pasts) and not (brief or at_work):
        stale(city, str(models or ""), voice)


def row(one: "Past") -> str:
    """Tell a run in a line."""
    took = "" if one.seconds is None else f"{one.seconds:.0f} s"
    facts = []
    if one.photos is not None and one.shown_share is not None:
        photos = plural.of(one.photos, "photo")
        facts.append(f"{photos}, {one.shown_share:.0%} of them shown")
    if one.cpu_seconds is not None:
        facts.append(f"{one.cpu_seconds:.0f} CPU s")
        if one.estimated_cpu_seconds:
            ratio = one.cpu_seconds / one.estimated_cpu_seconds
            facts.append(f"{ratio:.2f} of the estimate")
    told = ", ".join(facts)
    return f"{one.run}  {one.began:20}  {took:>8}  {one.state:10}  {told}".rstrip()


def timed(now: "State") -> Iterator[str]:
    """Tell where a schedule stands."""
    last = now.last
    made = f", {plural.of(last.photos, 'photograph')}" if last.photos else ""
    left = f", {last.later} left for the next time" if last.later else ""
    missed = f", made up for {last.missed} missed before it" if last.missed else ""
    yield f"last due {last.when:{DAY}} UTC: {last.outcome}{made}{left}{missed}"
    if now.overdue:
        yield f"missed since: {len(now.overdue)}, the first {now.overdue[0]:{DAY}} UTC"
    if now.following is not None:
        by = f"{last.cron} {last.zone}"
        yield f"next due {now.following:{DAY}} UTC ({by}), if a schedule is at work"
    for one in now.failures[-MOST:]:
        yield f"failed {one.when:{DAY}} UTC: {one.detail}"
    if len(now.failures) > MOST:
        more = plural.of(len(now.failures) - MOST, "failure")
        yield f"and {more} before: --json tells all"


def stale(city: str, models: str, voice: Voice) -> None:
    """Tell what is stale by its cause, as `reprocess --dry-run` does."""
    from pipelines.index.row import CSV
    from pipelines.index.source import PARQUET
    from pipelines.store import Store

    if not any(Store(city).exists(name) for name in (CSV, PARQUET)):
        return  # a copy, to be looked at
    known = looked(city, replace(voice, quiet=voice.machine), models).told()
    for line in [json.dumps({"stale": known})] if voice.machine else lines(known):
        voice.echo(line)
