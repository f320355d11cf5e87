"""`nostalgin explain`: one photograph through every stage."""

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from pipelines import bounded, plural
from pipelines.cli.launch import TOO_MANY_REJECTIONS, ModelsFolder
from pipelines.console import Quiet, Voice, errors, fail, unwritable

if TYPE_CHECKING:
    from pipelines.explain import Redrawn

EXAMPLES: Final = """
Examples:

  nostalgin explain photo.jpg -o out         [dim]# pictures and explain.json in out/[/]

  nostalgin explain photo.jpg -o out --no-placard

  nostalgin explain photo.jpg -o out --corrections city/corrections.csv
"""


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
    corrections: Annotated[
        Path | None,
        typer.Option(help="A city's corrections: what they draw on it is obeyed."),
    ] = None,
    models: ModelsFolder = None,
    quiet: Quiet = False,
) -> None:
    """Take one photo through every stage and show what each made of it.

    Writes every stage as a PNG, the stages side by side as panel.png, and their numbers
    as explain.json. The file's name is never looked at, but to find its corrections.
    """
    started = time.process_time()
    from pipelines.models import one_thread

    one_thread()
    from pipelines import explain
    from pipelines import models as shelf

    data = content(photo)
    voice = Voice(errors, quiet=quiet)
    mended = redrawn(photo, data, corrections, voice)
    try:
        networks = shelf.Models(str(models or "")).networks(placard=placard)
        given = {"every": every, "drawn": mended.drawn}
        report = explain.explain(data, out, networks, started=started, **given)
    except explain.Unreadable as problem:
        raise fail(f"{photo}: {problem}") from problem
    except shelf.Unlocked as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise unwritable(out, problem) from problem
    tell(report, out, voice)
    if mended.refused:
        raise typer.Exit(TOO_MANY_REJECTIONS)


def content(photo: Path) -> bytes:
    """Read a photograph's file, or end in words that name it."""
    try:
        return bounded.read(photo, bounded.PHOTO_BYTES)
    except OSError as problem:
        raise fail(f"{photo}: {problem.strerror}; name an image file") from problem


def tell(report: dict[str, Any], out: Path, voice: Voice) -> None:
    """Tell what was found in a photo, and where the pictures of it lie."""
    targets = sum(one["target"] for one in report["facades"])
    voice.echo(
        f"{plural.of(len(report['facades']), 'facade')} ({targets} target), "
        f"{plural.of(len(report['occluders']), 'occluder')}, "
        f"{report['seconds']['total']:.1f} CPU s"
    )
    for one in report["rejections"]:
        which = f" facade {one['facade']}" if one.get("facade") is not None else ""
        voice.echo(f"rejected{which}: {one['stage']}: {one['reason']}: {one['detail']}")
    voice.echo(f"see {out / 'panel.png'} and {out / 'explain.json'}")


def redrawn(photo: Path, data: bytes, listed: Path | None, voice: Voice) -> "Redrawn":
    """Read what is drawn on a photo, if that is asked for, and tell what is obeyed."""
    from pipelines import explain

    if listed is None:
        return explain.Redrawn()
    try:
        found = explain.redrawn(photo, data, listed)
    except OSError as problem:
        words = "name a corrections.csv or .jsonl"
        raise fail(f"{listed}: {problem.strerror}; {words}") from problem
    for line in found.told:
        voice.echo(line)
    for line in found.refused:
        voice.echo(f"rejected {line}")
    if found.empty:
        voice.echo(f"{listed} says nothing of {photo.name}")
    return found


def explain_front_command(
    city: Annotated[Path, typer.Argument(help="A finished city.")],
    front: Annotated[str, typer.Argument(help="A front's id, as 996-33-0.")],
    out: Annotated[Path, typer.Option("-o", "--out", help="Folder to write to.")],
    *,
    quiet: Quiet = False,
) -> None:
    """Show all views of one front, laid over each other, and what came from where.

    Writes every view as a PNG, all of them side by side as sheet.png, and which
    photograph lent how many texels as front.json.
    """
    from pipelines.models import one_thread

    one_thread()
    from pipelines import explain

    try:
        report = explain.explain_front(city, front, out)
    except explain.Unshown as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise unwritable(out, problem) from problem
    voice = Voice(errors, quiet=quiet)
    voice.echo(
        f"{front}: {report['unseen']:.1%} hidden in {report['photo']}, "
        f"{report['left']:.1%} in all {1 + len(report['views'])}"
    )
    for one in report["views"]:
        voice.echo(f"{one['photo']}: {one['why'] or str(one['lent']) + ' texels'}")
    voice.echo(f"see {out / 'sheet.png'} and {out / 'front.json'}")
