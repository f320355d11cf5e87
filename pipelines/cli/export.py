"""`nostalgin export`: a published city for other programs."""

from pathlib import Path
from typing import Annotated, Final

import typer

from pipelines import plural
from pipelines.console import Quiet, Voice, errors, fail, unwritable

EXAMPLES: Final = """
Examples:

  nostalgin export city --to cityjson,obj

  nostalgin export city --to geojson,prov -o out

  nostalgin export city --to iiif --base https://archive.example/city/
"""


def export_command(
    city: Annotated[Path, typer.Argument(help="The city folder that was built.")],
    *,
    to: Annotated[
        str, typer.Option(help="cityjson, obj, geojson, prov, iiif; with commas.")
    ] = "cityjson,obj,prov",
    out: Annotated[
        Path | None, typer.Option("-o", "--out", help="Else CITY/exports.")
    ] = None,
    base: Annotated[
        str, typer.Option(help="For iiif: the address where the site will lie.")
    ] = "",
    quiet: Quiet = False,
) -> None:
    """Write the city that is shown in other formats, from its own models.

    docs/outputs.md tells what each file holds. A block's GLB and the city's 3D Tiles
    lie in CITY/site already.
    """
    from pipelines import formats
    from pipelines.site import Foreign

    voice = Voice(errors, quiet=quiet)

    def tell(block: str, done: int) -> None:
        if done % 100 == 0:
            words = plural.of(done, "block")
            voice.say("exported", words, block=block, done=done)

    target = out or city / "exports"
    wanted = list(dict.fromkeys(one.strip() for one in to.split(",") if one.strip()))
    try:
        done = formats.export(city, target, wanted, base=base, tell=tell)
    except (formats.Unexportable, Foreign) as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise unwritable(target, problem) from problem
    for name, count in done.files.items():
        voice.echo(f"{target / name}: {plural.of(count, 'file')}")
    failed = [fail(f"{name}: {why}") for name, why in done.refused.items()]
    if failed:
        raise failed[0]
