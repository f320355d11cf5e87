"""`nostalgin reprocess`: what is stale in a city is redone, and nothing else."""

import json
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from pipelines import plural, stopping
from pipelines.cli.grown import indexed_again, indexed_dry
from pipelines.cli.launch import (
    TOO_MANY_REJECTIONS,
    City,
    JsonLines,
    ModelsFolder,
    Retry,
    failing,
    patient,
    told,
)
from pipelines.console import Quiet, Voice, Watch, errors, fail, summed, unwritable

if TYPE_CHECKING:
    from pipelines.reprocess import Plan, Reprocessed

EXAMPLES: Final = """
Examples:

  nostalgin reprocess city --dry-run        [dim]# tell what is stale, and its cost[/]

  nostalgin reprocess city --direct_num_workers 2

  nostalgin reprocess city --budget 1000    [dim]# photographs; the rest another time[/]

  nostalgin reprocess city --rollback 0a1b2c3d4e5f    [dim]# show a kept run again[/]
"""


def reprocess_command(
    context: typer.Context,
    city: City,
    *,
    dry_run: Annotated[
        bool,
        typer.Option("--dry-run", help="Tell what would be redone; write nothing."),
    ] = False,
    thorough: Annotated[
        bool, typer.Option("--thorough", help="Hash every photograph's bytes.")
    ] = False,
    budget: Annotated[
        int, typer.Option(min=0, help="Photographs at most; the rest the next time.")
    ] = 0,
    rollback: Annotated[
        str, typer.Option(metavar="RUN", help="Show this kept run again; redo nothing.")
    ] = "",
    index: Annotated[
        bool, typer.Option(help="Index a folder again that is not what it was.")
    ] = True,
    retry: Retry = False,
    models: ModelsFolder = None,
    json_lines: JsonLines = False,
    quiet: Quiet = False,
) -> None:
    """Redo what is stale: new, changed and removed photos, corrections, new versions.

    Where the folder of photographs or the list is not what it was when it was indexed,
    it is indexed again first. Blocks that none of this touches stay as they are, and
    are not opened.
    """
    voice = Voice(errors, machine=json_lines, quiet=quiet)
    if rollback:
        if dry_run or thorough or budget or retry or context.args:
            raise typer.BadParameter("--rollback takes no other options of a run")
        again(city, rollback, voice)
        return
    asked = {"budget": budget, "thorough": thorough, "index": index}
    if dry_run:
        tell(looked(city, voice, str(models or ""), **asked, retry=retry), voice)
        return
    with stopping.heeded(patient):
        beam = [*context.args, *["--retry"] * retry]
        done = redone(city, voice, str(models or ""), beam, **asked)
    if done.report is not None and done.report.held:
        raise typer.Exit(TOO_MANY_REJECTIONS)


def again(city: str, run: str, voice: Voice) -> None:
    """Show an earlier run again, or tell why that can't be."""
    from pipelines import reprocess
    from pipelines.store import Store, secretive

    if secretive(city):
        raise typer.BadParameter("credentials in the URI: give them by the environment")
    try:
        with failing(city):
            reprocess.rollback(Store(city), run, tell=voice.say)
    except reprocess.Unkept as problem:
        raise fail(str(problem)) from problem
    words = f"run {run} is shown; the manifest stays: what follows from it comes back"
    voice.say("shown", f"{words} with the next build or reprocess", run=run)


def redone(
    city: str,
    voice: Voice,
    models: str,
    beam: Sequence[str],
    *,
    index: bool = True,
    **asked: Any,
) -> "Reprocessed":
    """Redo what is stale, and tell what came of it or what went wrong."""
    options = told(city, models=models, beam=beam)
    if index:
        indexed_again(city, voice, models, beam)
    from pipelines import reprocess

    with failing(city):
        done = reprocess.reprocess(
            options, tell=voice.say, watch=partial(Watch, voice), **asked
        )
    if done.report is None:
        voice.say("done", lines(done.plan.told())[0], **done.plan.told())
    else:
        later = done.plan.later
        words = f"; {plural.of(later, 'stale photograph')} left for the next time"
        counts = f"{plural.of(done.plan.photos, 'photograph')} and "
        counts += f"{plural.of(done.plan.blocks, 'block')} redone"
        known = done.plan.told() | {"spent_cpu_seconds": done.report.cpu_seconds}
        counts += spent(done.plan.cpu_seconds, done.report.cpu_seconds)
        voice.say("reprocessed", counts + words * bool(later), **known)
        summed(done.report, voice)
    return done


def spent(estimated: float | None, cpu_s: float) -> str:
    """Tell what was spent, and how far an estimate was from it."""
    said = f", {cpu_s:.1f} CPU s"
    if not estimated:
        return said
    return f"{said}, {cpu_s / estimated:.2f} of the estimated {estimated:.1f}"


def looked(
    city: str, voice: Voice, models: str, *, index: bool = True, **asked: Any
) -> "Plan":
    """Find what is stale, or tell why that can't be."""
    from pipelines import reprocess
    from pipelines.index.manifest import Unusable
    from pipelines.models import Models, Unlocked
    from pipelines.store import Damaged, Store, secretive

    if secretive(city):
        raise typer.BadParameter("credentials in the URI: give them by the environment")
    try:
        networks = Models(models) if models else Models()
        there = indexed_dry(city, voice, models) if index else None
        now = reprocess.now(Store(city), networks, there=there)
        return reprocess.planned(now, **asked)
    except (Unusable, Unlocked, Damaged) as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise unwritable(city, problem) from problem


def tell(plan: "Plan", voice: Voice) -> None:
    """Tell a plan on the standard output."""
    known = plan.told()
    if voice.machine:
        voice.echo(json.dumps(known))
        return
    for line in lines(known):
        voice.echo(line)


def lines(known: dict[str, Any]) -> list[str]:
    """Tell a plan to people."""
    refused = known["corrections_rejected"]
    words = f"{plural.of(refused, 'correction')} rejected: `nostalgin corrections`"
    last = [f"{words} tells why"] if refused else []
    last += left_alone(known["left_alone"], known["left_alone_first"])
    if not (known["photos"] or known["blocks"] or known["moved"]):
        said = f"nothing is stale: run {known['before']} is what is asked for"
        return [said, *last]
    causes = ", ".join(f"{n} {name}" for name, n in known["causes"].items())
    rows = ", ".join(f"{n} by {name}" for name, n in known["blocks_by_cause"].items())
    photos = known["photos_asked"] + known["photos_gone"]
    blocks = known["blocks_asked"] + known["blocks_gone"]
    said = [
        f"{known['photos']} of {plural.of(photos, 'photograph')} to be redone"
        + (f" ({causes})" if causes else ""),
        f"{known['blocks']} of {plural.of(blocks, 'block')} to be looked at again"
        + (f" ({rows})" if rows else ""),
    ]
    if known["moved"]:
        said.append("the city's places or its title are others: the site is written")
    made = ", ".join(f"{name} {n}" for name, n in known["made"].items())
    said.append(f"to be made at most: {made or 'nothing'}")
    if known["cpu_seconds"] is not None:
        said.append(
            f"estimated: {known['cpu_seconds']:.0f} CPU s, {known['seconds']:.0f} s"
        )
    if known["later"]:
        later = plural.of(known["later"], "stale photograph")
        said.append(f"{later} left for the next time")
    return [*said, *last]


def left_alone(count: int, first: Sequence[str]) -> list[str]:
    """Tell what crashed too often to be tried again, if something did."""
    if not count:
        return []
    names = ", ".join(first) + f" and {count - len(first)} more" * (count > len(first))
    what = plural.of(count, "photograph or block", "photographs and blocks")
    return [
        (
            f"{what} let be after crashes: {names}; try again by "
            "`nostalgin reprocess --retry`"
        )
    ]
