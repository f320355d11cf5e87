"""`nostalgin gc`: what no kept run refers to is dropped from a city folder."""

from typing import Annotated, Final

import typer

from pipelines import plural
from pipelines.cli.launch import City, JsonLines
from pipelines.console import Quiet, Voice, errors, fail, unwritable

EXAMPLES: Final = """
Examples:

  nostalgin gc city --dry-run          [dim]# tell what would be dropped[/]

  nostalgin gc city --keep 3           [dim]# the published run, and the last three[/]
"""


def gc_command(
    city: City,
    *,
    keep: Annotated[
        int, typer.Option(min=0, help="Runs to keep beside the published one.")
    ] = 1,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Drop nothing, tell what would be.")
    ] = False,
    json_lines: JsonLines = False,
    quiet: Quiet = False,
) -> None:
    """Drop runs that are not kept, and artifacts that no kept run refers to.

    A bucket has no lock: see that no run is at work there.
    """
    from pipelines.store import Busy, Store, held, secretive
    from pipelines.store.refuse import Unknown, drop_unkept

    if secretive(city):
        raise typer.BadParameter("credentials in the URI: give them by the environment")
    try:
        store = Store(city)
        with held(store):
            done = drop_unkept(store, keep=keep, dry=dry_run)
    except (Busy, Unknown) as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise unwritable(city, problem) from problem
    words = "would be dropped" if dry_run else "dropped"
    Voice(errors, machine=json_lines, quiet=quiet).say(
        "done",
        f"{plural.of(done.artifacts, 'artifact')} and "
        f"{plural.of(len(done.runs), 'run')} {words}, "
        f"{plural.of(len(done.kept_runs), 'run')} kept",
        artifacts=done.artifacts,
        packs=done.packs,
        runs=list(done.runs),
        kept=list(done.kept_runs),
        dry=dry_run,
    )
