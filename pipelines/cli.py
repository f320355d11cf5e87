"""The command line: `nostalgin demo | index | build | view | explain | evaluate`.

Exit codes: 0 done, 1 failed, 2 wrong usage, 3 done with more rejections than allowed,
with most photos of no known place, or without one photograph.
Beam and the networks are imported by the commands that need them, so that `--help`
answers at once.
"""

import os
import sys
import time
from pathlib import Path
from typing import Annotated, Final

import typer

from pipelines import bounded
from pipelines.console import (
    Voice,
    echo,
    errors,
    examples,
    fail,
    indexed,
    opened_streams,
    unwritable,
)
from pipelines.evaluate import commands
from pipelines.launch import built, told

TOO_MANY_REJECTIONS: Final = 3
MOST_WORKERS: Final = 4  # of the demo; each holds both networks

app = typer.Typer(
    name="nostalgin",
    help="Turn historical street photographs into a city to walk through.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
)
app.add_typer(commands.app, name="evaluate")

ModelsFolder = Annotated[
    Path | None,
    typer.Option("--models", help="Folder with other networks and their models.lock."),
]


@app.callback()
def nostalgin() -> None:
    """Turn historical street photographs into a city to walk through."""


JsonLines = Annotated[
    bool, typer.Option("--json", help="Tell progress as JSON, a line an event.")
]


@app.command("explain", epilog=examples.EXPLAIN)
def explain_command(
    photo: Annotated[Path, typer.Argument(help="The photograph.")],
    out: Annotated[Path, typer.Option("-o", "--out", help="Folder to write to.")],
    *,
    placard: Annotated[
        bool, typer.Option(help="Read the number board in the photo.")
    ] = True,
    every: Annotated[
        bool,
        typer.Option(
            "--every-facade",
            help="Inpaint the neighbours' facades, too; it takes time.",
        ),
    ] = False,
    models: ModelsFolder = None,
) -> None:
    """Take one photo through every stage and show what each made of it.

    Writes every stage as a PNG, the stages side by side as panel.png, and their numbers
    as explain.json. The file's name is never looked at.
    """
    started = time.process_time()
    from pipelines.models import one_thread

    one_thread()
    from pipelines import explain
    from pipelines import models as shelf

    try:
        data = bounded.read(photo, bounded.PHOTO_BYTES)
    except OSError as problem:
        raise fail(f"{photo}: {problem.strerror}; name an image file") from problem
    try:
        networks = shelf.Models(str(models or shelf.PACKAGED)).networks(placard=placard)
        report = explain.explain(data, out, networks, started=started, every=every)
    except explain.Unreadable as problem:
        raise fail(f"{photo}: {problem}") from problem
    except shelf.Unlocked as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise unwritable(out, problem) from problem
    targets = sum(one["target"] for one in report["facades"])
    echo(
        f"{len(report['facades'])} facades ({targets} target), "
        f"{len(report['occluders'])} occluders, {report['seconds']['total']:.1f} CPU s"
    )
    for one in report["rejections"]:
        which = f" facade {one['facade']}" if one.get("facade") is not None else ""
        echo(f"rejected{which}: {one['stage']}: {one['reason']}: {one['detail']}")
    echo(f"see {out / 'panel.png'} and {out / 'explain.json'}")


@app.command("index", epilog=examples.INDEX)
def index_command(
    photos: Annotated[Path, typer.Argument(help="The folder that holds the photos.")],
    city: Annotated[str, typer.Option("-o", "--out", help="City folder to write to.")],
    *,
    catalogue: Annotated[
        Path | None, typer.Option(help="CSV with block, lot, street, address, width.")
    ] = None,
    block: Annotated[
        list[str] | None, typer.Option(help="Take this block alone; may be repeated.")
    ] = None,
    credit: Annotated[str, typer.Option(help="Whom to name beside the photos.")] = "",
    title: Annotated[
        str, typer.Option(help="The city's name on its page; else its folder's.")
    ] = "",
    force: Annotated[
        bool, typer.Option("--force", help="Replace a mended manifest; a copy is kept.")
    ] = False,
    json_lines: JsonLines = False,
) -> None:
    """Write a city folder's manifest: which photo shows which fronts, in what order.

    It is written as manifest.csv too, to be mended by hand; docs/manifest.md describes
    its columns.
    """
    from pipelines import index
    from pipelines.store import Busy, Store, held

    voice = Voice(errors, machine=json_lines)
    named = {"credit": credit, "title": title}
    try:
        with held(Store(city)):
            made = index.index(
                photos, catalogue, city, blocks=block or (), force=force, **named
            )
    except (index.Nothing, Busy) as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise unwritable(city, problem) from problem
    indexed(made, city, voice)
    if made.astray:
        raise typer.Exit(TOO_MANY_REJECTIONS)


@app.command(
    "build",
    epilog=examples.BUILD,
    context_settings={"allow_extra_args": True, "ignore_unknown_options": True},
)
def build_command(
    context: typer.Context,
    city: Annotated[str, typer.Argument(help="The city folder that `index` made.")],
    *,
    shard: Annotated[str, typer.Option(help="Part of the blocks, as 3/16.")] = "",
    models: ModelsFolder = None,
    allow_scheme: Annotated[
        list[str] | None,
        typer.Option(help="Let the manifest's roots be gs://... ; may be repeated."),
    ] = None,
    max_rejected: Annotated[
        float,
        typer.Option(
            min=0,
            max=1,
            help="Share of photos that may give nothing; above it, exit 3.",
        ),
    ] = 0.5,
    publish_anyway: Annotated[
        bool,
        typer.Option("--publish-anyway", help="Replace a site that shows more, too."),
    ] = False,
    retry: Annotated[
        bool, typer.Option("--retry", help="Try again what ended its process twice.")
    ] = False,
    seconds: Annotated[
        float,
        typer.Option("--stage-seconds", min=0, help="A stage's time for a photo."),
    ] = 300.0,
    gigabytes: Annotated[
        float, typer.Option("--stage-gigabytes", min=0.5, help="And its memory.")
    ] = 4.0,
    json_lines: JsonLines = False,
) -> None:
    """Build the city: every photo through every stage, one model a block, the site.

    What was done before is found and kept, so a run that was stopped goes on where it
    was. All other options go to Beam.
    """
    voice = Voice(errors, machine=json_lines)
    asked = {"models": str(models or ""), "shard": shard, "schemes": allow_scheme or ()}
    limits = [f"--stage_seconds={seconds}", f"--stage_gigabytes={gigabytes}"]
    flags = ["--retry"] * retry + ["--publish_anyway"] * publish_anyway
    report = built(city, voice, **asked, beam=[*context.args, *limits, *flags])
    whole = bool(report.blocks and report.photos)  # what no photo shows is assumed
    poor = report.rejected_share > max_rejected or report.held
    if poor or not (whole or shard):
        raise typer.Exit(TOO_MANY_REJECTIONS)


@app.command("view", epilog=examples.VIEW)
def view_command(
    city: Annotated[Path, typer.Argument(help="The city folder, or its site.")],
    *,
    port: Annotated[
        int,
        typer.Option(min=0, max=65535, help="Port on this machine; 0 takes any."),
    ] = 0,
    browser: Annotated[bool, typer.Option(help="Open a browser.")] = True,
) -> None:
    """Serve the city to this machine alone and open it in a browser."""
    from pipelines.view import NoSiteError, site_of, view

    try:
        site = site_of(city)
    except NoSiteError as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise fail(f"{city}: {problem.strerror}; name a city folder") from problem
    try:
        view(site, port=port, browser=browser)
    except OSError as problem:
        raise fail(f"port {port}: {problem.strerror}; take another") from problem


@app.command(
    "demo",
    epilog=examples.DEMO,
    context_settings={"allow_extra_args": True, "ignore_unknown_options": True},
)
def demo_command(
    context: typer.Context,
    folder: Annotated[
        Path, typer.Option("-o", "--out", help="Where to put it.")
    ] = Path("demo-city"),
    *,
    blocks: Annotated[int, typer.Option(min=1, max=3, help="How many blocks.")] = 2,
    browser: Annotated[bool, typer.Option(help="Open a browser at the end.")] = True,
    json_lines: JsonLines = False,
) -> None:
    """Paint a neighbourhood, photograph it, rebuild it from the photos, and show it.

    Without a terminal it prints where the site lies, and ends. All other options go to
    Beam; without any, a process works on each core, up to four.
    """
    from pipelines.models import one_thread

    one_thread()
    from pipelines import index
    from pipelines.demo import CREDIT, TITLE, painted
    from pipelines.view import view

    voice = Voice(errors, machine=json_lines)

    def tell(done: int, whole: int) -> None:
        if done % 10 == 0 or done == whole:
            words = f"painted {done} of {whole} photographs"
            voice.say("painted", words, done=done, whole=whole)

    workers = [f"--direct_num_workers={min(os.cpu_count() or 1, MOST_WORKERS)}"]
    beam = context.args or workers
    told(str(folder), beam=beam)  # a mistyped option is told before anything is painted
    try:
        photos, listed = painted(folder, blocks=blocks, tell=tell)
        named = {"credit": CREDIT, "title": TITLE}
        made = index.index(photos, listed, str(folder), force=True, **named)
    except OSError as problem:
        raise unwritable(folder, problem) from problem
    for warning in made.warnings:
        voice.say("warning", f"warning: {warning}", warning=warning)
    built(str(folder), voice, beam=beam)
    site = folder / "site"
    voice.say(
        "site", f"the site lies in {site}: nostalgin view {folder}", site=str(site)
    )
    if browser and sys.stdout.isatty():
        view(folder)


def main() -> None:
    """Run the command line."""
    opened_streams()
    app()


if __name__ == "__main__":
    sys.exit(main())
