"""`nostalgin index`: a folder of photographs and a list become a manifest."""

from typing import Annotated, Final

import typer

from pipelines.cli.launch import TOO_MANY_REJECTIONS, JsonLines, Quiet
from pipelines.console import Voice, errors, fail, indexed, unwritable

EXAMPLES: Final = """
Examples:

  nostalgin index photos --catalogue list.csv -o city

  nostalgin index photos -o city                      [dim]# file names tell the lots[/]

  nostalgin index photos --catalogue list.csv -o city --block 993

  nostalgin index photos -o city --title "Midtown, 1940"

  nostalgin index https://iiif.example.org/street/manifest.json -o city
"""


def index_command(
    photos: Annotated[
        str, typer.Argument(help="The folder of the photos, or a IIIF manifest.")
    ],
    city: Annotated[str, typer.Option("-o", "--out", help="City folder to write to.")],
    *,
    catalogue: Annotated[
        str | None,
        typer.Option(help="A list with block, lot, street...: CSV, JSON or IIIF."),
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
    quiet: Quiet = False,
) -> None:
    """Write a city folder's manifest: which photo shows which fronts, in what order.

    It is written as manifest.csv too, to be mended by hand; docs/manifest.md describes
    its columns.
    """
    from pipelines import index
    from pipelines.store import Busy, Store, held

    voice = Voice(errors, machine=json_lines, quiet=quiet)
    named = {"credit": credit, "title": title}
    try:
        with held(Store(city)):
            made = index.index(
                photos,
                catalogue,
                city,
                blocks=block or (),
                force=force,
                tell=voice.say,
                **named,
            )
    except (index.Nothing, Busy) as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise unwritable(city, problem) from problem
    indexed(made, city, voice)
    if made.astray:
        raise typer.Exit(TOO_MANY_REJECTIONS)
