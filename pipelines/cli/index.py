"""`nostalgin index`: a folder of photographs and a list become a manifest."""

from pathlib import Path
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

  nostalgin index photos --catalogue list.csv -o city --outlines footprints.geojson

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
    outlines: Annotated[
        Path | None,
        typer.Option(help="GeoJSON or CityJSON of buildings or blocks, with a key."),
    ] = None,
    outline_key: Annotated[
        str, typer.Option(help="The property of an outline that names its block.")
    ] = "",
    outline_crs: Annotated[
        str, typer.Option(help="The outlines' reference system, as EPSG:2263.")
    ] = "",
    places: Annotated[
        Path | None, typer.Option(help="CSV with block, lon, lat and maybe bearing.")
    ] = None,
    place: Annotated[
        str, typer.Option(help="LAT,LON,BEARING of the first block, for a whole city.")
    ] = "",
    streets: Annotated[
        Path | None, typer.Option(help="CSV with street and width_m.")
    ] = None,
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
    told = index.Asked(outlines, outline_key, outline_crs, places, place, streets)
    try:
        with held(Store(city)):
            made = index.index(
                photos,
                catalogue,
                city,
                blocks=block or (),
                force=force,
                places=told,
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
