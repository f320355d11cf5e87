"""`nostalgin index`: a folder of photographs and a list become a manifest."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer

from pipelines.cli.asking import Whose, asking
from pipelines.cli.launch import TOO_MANY_REJECTIONS, JsonLines, ModelsFolder
from pipelines.console import Quiet, Voice, errors, fail, indexed, unwritable

if TYPE_CHECKING:
    from collections.abc import Callable

    from pipelines.index import Indexed

EXAMPLES: Final = """
Examples:

  nostalgin index photos --catalogue list.csv -o city

  nostalgin index photos -o city                      [dim]# file names tell the lots[/]

  nostalgin index photos --catalogue list.csv -o city --block 993

  nostalgin index photos -o city --title "Midtown, 1940"

  nostalgin index photos --catalogue list.csv -o city --outlines footprints.geojson

  nostalgin index scans --catalogue list.csv -o city --boards all

  nostalgin index scans --profile plain -o city        [dim]# names tell nothing[/]

  nostalgin index https://iiif.example.org/street/manifest.json -o city
"""

List = Annotated[
    str | None,
    typer.Option(help="A list with block, lot, street...: CSV, JSON or IIIF."),
]
Encoding = Annotated[
    str,
    typer.Option(
        help="Of the list, as cp1252 or mac-roman; else UTF-8 and UTF-16 are known, "
        "and cp1252 is guessed."
    ),
]
Blocks = Annotated[
    list[str] | None, typer.Option(help="Take this block alone; may be repeated.")
]
Credit = Annotated[str, typer.Option(help="Whom to name beside the photos.")]
Title = Annotated[
    str, typer.Option(help="The city's name on its page; else its folder's.")
]
Force = Annotated[
    bool, typer.Option("--force", help="Replace a mended manifest; a copy is kept.")
]
Outlines = Annotated[
    Path | None,
    typer.Option(help="GeoJSON or CityJSON of buildings or blocks, with a key."),
]
OutlineKey = Annotated[
    str, typer.Option(help="The property of an outline that names its block.")
]
OutlineCrs = Annotated[
    str, typer.Option(help="The outlines' reference system, as EPSG:2263.")
]
Places = Annotated[
    Path | None, typer.Option(help="CSV with block, lon, lat and maybe bearing.")
]
Place = Annotated[
    str, typer.Option(help="LAT,LON,BEARING of the first block, for a whole city.")
]
Boards = Annotated[
    Whose,
    typer.Option(
        help="Whose number boards are read: of photographs that neither their name "
        "nor the list places, of all, or of none."
    ),
]
Archive = Annotated[
    str,
    typer.Option(
        help="How files are named and what boards are like: nyc-1940, plain, or a TOML "
        "file of one's own (docs/placards.md)."
    ),
]
Streets = Annotated[Path | None, typer.Option(help="CSV with street and width_m.")]


def index_command(
    context: typer.Context,
    photos: Annotated[
        str, typer.Argument(help="The folder of the photos, or a IIIF manifest.")
    ],
    city: Annotated[str, typer.Option("-o", "--out", help="City folder to write to.")],
    *,
    catalogue: List = None,
    encoding: Encoding = "",
    block: Blocks = None,
    credit: Credit = "",
    title: Title = "",
    force: Force = False,
    outlines: Outlines = None,
    outline_key: OutlineKey = "",
    outline_crs: OutlineCrs = "",
    places: Places = None,
    place: Place = "",
    streets: Streets = None,
    boards: Boards = Whose.silent,
    profile: Archive = "nyc-1940",
    models: ModelsFolder = None,
    json_lines: JsonLines = False,
    quiet: Quiet = False,
) -> None:
    """Write a city folder's manifest: which photo shows which fronts, in what order.

    It is written as manifest.csv too, to be mended by hand; docs/manifest.md describes
    its columns.
    """
    from pipelines import index

    voice = Voice(errors, machine=json_lines, quiet=quiet)
    shelf = {"models": str(models or ""), "beam": context.args}
    ask = asking(city, boards, voice, **shelf)
    told = {"outline_key": outline_key, "outline_crs": outline_crs, "place": place}
    told |= {"credit": credit, "title": title, "blocks": tuple(block or ())}
    told |= {"encoding": encoding}
    files = {"catalogue": catalogue, "outlines": outlines, "places": places}
    files |= {"streets": streets, "profile": profile}
    wish = index.Wish.told(photos, boards=boards.value, **files, **told)

    def work() -> "Indexed":
        return index.fulfilled(wish, city, ask=ask, force=force, tell=voice.say)

    made = kept_from_others(city, work)
    indexed(made, city, voice)
    if made.astray:
        raise typer.Exit(TOO_MANY_REJECTIONS)


def kept_from_others(city: str, work: "Callable[[], Indexed]") -> "Indexed":
    """Do something with a city folder that no run is at work in; tell what hinders."""
    from pipelines import index
    from pipelines.store import Busy, Store, held

    try:
        with held(Store(city)):
            return work()
    except (index.Nothing, Busy) as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise unwritable(city, problem) from problem
