"""`nostalgin report` and `nostalgin status`: what came of a city, and of its runs."""

import json
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Final

import typer

from pipelines.cli.launch import JsonLines
from pipelines.console import Quiet, Voice, errors, fail, unwritable

EXAMPLES: Final = """
Examples:

  nostalgin report city                       [dim]# writes city/report.html[/]

  nostalgin report city -o page.html --run 88530d99ac8d
"""
STATUS_EXAMPLES: Final = """
Examples:

  nostalgin status city

  nostalgin status city --json
"""


def report_command(
    city: Annotated[Path, typer.Argument(help="The city folder.")],
    *,
    out: Annotated[
        Path | None, typer.Option("-o", "--out", help="The page; else report.html.")
    ] = None,
    run: Annotated[str, typer.Option(help="A run; else the one that is shown.")] = "",
    quiet: Quiet = False,
) -> None:
    """Write a page of what was built: rejections, time, evidence, heights, the worst.

    It is one file with its pictures in it, to be kept or sent.
    """
    from pipelines import report
    from pipelines.index import of_folder
    from pipelines.store import Damaged, Store

    store, target = Store(str(city)), out or city / "report.html"
    try:
        found = report.figures(store, run)
        text = report.page(found, store, title=of_folder(city.resolve().name))
    except (report.NoRun, Damaged) as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise fail(f"{city}: {problem.strerror}; name a city folder") from problem
    try:
        target.write_text(text, encoding="utf-8", errors="replace")
    except OSError as problem:
        raise unwritable(target, problem) from problem
    Voice(errors, quiet=quiet).echo(f"see {target}")


def status_command(
    city: Annotated[Path, typer.Argument(help="The city folder.")],
    *,
    json_lines: JsonLines = False,
    quiet: Quiet = False,
) -> None:
    """List a city's runs: when, how long, how many photos, and which one is shown."""
    from pipelines import report
    from pipelines.store import Store, busy

    store = Store(str(city))
    try:
        pasts, at_work = report.history(store), busy(store)
    except OSError as problem:
        raise fail(f"{city}: {problem.strerror}; name a city folder") from problem
    voice = Voice(errors, quiet=quiet)
    if json_lines:
        for one in pasts:
            voice.echo(json.dumps(asdict(one) | {"state": one.state}))
        return
    for one in pasts:
        took = "" if one.seconds is None else f"{one.seconds:.0f} s"
        shown = ""
        if one.photos is not None and one.shown_share is not None:
            shown = f"{one.photos} photos, {one.shown_share:.0%} of them shown"
        voice.echo(
            f"{one.run}  {one.began:20}  {took:>8}  {one.state:10}  {shown}".rstrip()
        )
    if not pasts:
        voice.echo(f"{city}: nothing was built there yet; run `nostalgin build`")
    if at_work:
        voice.echo(f"a run is at work there{at_work}")
