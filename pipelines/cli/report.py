"""`nostalgin report`: what came of a run, as one page."""

from pathlib import Path
from typing import Annotated, Final

import typer

from pipelines.console import Quiet, Voice, errors, fail, unreadable, unwritable

EXAMPLES: Final = """
Examples:

  nostalgin report city                       [dim]# writes city/report.html[/]

  nostalgin report city -o page.html --run 88530d99ac8d
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
        raise unreadable(city, problem) from problem
    try:
        target.write_text(text, encoding="utf-8", errors="replace")
    except OSError as problem:
        raise unwritable(target, problem) from problem
    Voice(errors, quiet=quiet).echo(f"see {target}")
