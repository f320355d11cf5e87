"""`nostalgin evaluate`: the paper's tables on folders of labelled photographs.

Each subcommand prints one report, as tables for people or, with `--json`, as JSON.
What is measured is told in the module of the same name beside this one.
"""

from pathlib import Path
from typing import Annotated

import typer

from pipelines.console import Quiet
from pipelines.evaluate.asked import AsJson, ModelsFolder, measuring, network, tell

app = typer.Typer(
    help="Measure a stage against labelled data.",
    no_args_is_help=True,
    add_completion=False,
)


City = Annotated[Path, typer.Argument(help="A finished city of its photographs.")]
Block = Annotated[str, typer.Option(help="How the labels' names begin.")]


@app.callback()
def evaluate() -> None:
    """Measure a stage against labelled data."""


@app.command("segmentation")
def segmentation_command(
    folder: Annotated[Path, typer.Argument(help="Holds photos/ and labels/.")],
    *,
    block: Block = "",
    sheet: Annotated[
        Path | None, typer.Option(help="Folder for pictures of each kind of error.")
    ] = None,
    models: ModelsFolder = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Measure how well fronts and what hides them are found: the paper's table 1."""
    with measuring():
        from pipelines.evaluate import labels

        labelled = labels.pairs(folder, block=block)
        from pipelines.evaluate import segmentation, segmentation_table

        report = segmentation.evaluate(
            labelled, network(models, "segment"), sheet=sheet
        )
    tell(report, segmentation_table.text(report), as_json=as_json, quiet=quiet)


RECTIFICATION_EXAMPLES = """
Examples:

  nostalgin evaluate rectification DATA --parts labels --block 00993

  nostalgin evaluate rectification DATA --parts york_urban --detector ours,lsd,hough

  nostalgin evaluate rectification DATA --parts painted --fronts 500 --keep painted
"""


@app.command("rectification", epilog=RECTIFICATION_EXAMPLES)
def rectification_command(
    data: Annotated[
        Path,
        typer.Argument(help="Holds york_urban/, taxphotos/, historic_streets/."),
    ],
    *,
    parts: Annotated[
        str | None,
        typer.Option(help="york_urban,labels,painted,table2; all that have data."),
    ] = None,
    detector: Annotated[
        str, typer.Option(help="Which lines: ours,lsd,hough; one or several.")
    ] = "ours",
    block: Block = "",
    fronts: Annotated[int, typer.Option(min=1, help="Painted fronts.")] = 60,
    keep: Annotated[
        Path | None, typer.Option(help="Folder to keep painted photos in.")
    ] = None,
    sheet: Annotated[
        Path | None, typer.Option(help="Folder for the labels' contact sheets.")
    ] = None,
    pictures: Annotated[
        Path | None, typer.Option(help="Folder for pictures of all detectors' lines.")
    ] = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Measure how well fronts are straightened, and the paper's table 2."""
    with measuring():
        from pipelines.evaluate import rectification, rectification_table

        report = rectification.evaluate(
            data,
            parts=tuple(parts.split(",")) if parts is not None else None,
            detector=tuple(detector.split(",")),
            block=block,
            fronts=fronts,
            keep=keep,
            sheets=sheet,
            drawn=pictures,
        )
    tell(report, rectification_table.text(report), as_json=as_json, quiet=quiet)


INPAINTING_EXAMPLES = """
Examples:

  nostalgin evaluate inpainting DATA --most 40

  nostalgin evaluate inpainting images --holes free --methods telea,ours-low-memory

What widths and strides cost (the paper's table 4 and sweep) needs torch:
python -m export.inpainter_costs
"""


@app.command("inpainting", epilog=INPAINTING_EXAMPLES)
def inpainting_command(
    folder: Annotated[
        Path, typer.Argument(help="Images, or photos/ and labels/, or all the data.")
    ],
    *,
    methods: Annotated[
        str | None, typer.Option(help="Names, with commas; all by default.")
    ] = None,
    holes: Annotated[
        str | None, typer.Option(help="free or foot; both by default.")
    ] = None,
    most: Annotated[
        int | None, typer.Option(min=1, help="How many pictures at most.")
    ] = None,
    models: ModelsFolder = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Measure how well holes are filled: the paper's table 3."""
    with measuring():
        from pipelines.evaluate import inpainting

        report = inpainting.evaluate(
            folder,
            network(models, "inpaint"),
            wanted=methods,
            holes=None if holes is None else (holes,),
            most=most,
        )
    tell(report, inpainting.text(report), as_json=as_json, quiet=quiet)


@app.command("slips")
def slips_command(
    listed: Annotated[Path, typer.Argument(help="An archive's list, as index reads.")],
    *,
    blocks: Annotated[str, typer.Option(help="Some of its blocks, by commas.")] = "",
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Measure how far one slip of a list reaches: every kind, in every row."""
    with measuring():
        from pipelines.evaluate import slips

        wanted = [name.strip() for name in blocks.split(",") if name.strip()]
        report = slips.evaluate(listed, blocks=wanted)
    tell(report, slips.text(report), as_json=as_json, quiet=quiet)


@app.command("heights")
def heights_command(
    data: Annotated[Path, typer.Argument(help="Holds storeys.csv, counted by eye.")],
    city: City,
    *,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Measure heights against storeys counted by eye; wrong ones by name."""
    with measuring():
        from pipelines.evaluate import heights

        report = heights.evaluate(data, city)
    tell(report, heights.text(report), as_json=as_json, quiet=quiet)


@app.command("city")
def city_command(
    data: Annotated[
        Path, typer.Argument(help="Holds labels/, lots.json and storeys.csv.")
    ],
    city: City,
    *,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Measure a city lot by lot: street, side, order, width, height; wrong ones."""
    with measuring():
        from pipelines.evaluate import layout

        report = layout.evaluate(data, city)
    tell(report, layout.text(report), as_json=as_json, quiet=quiet)


@app.command("watermark")
def watermark_command(
    folder: Annotated[Path, typer.Argument(help="Copies that bear the watermark.")],
    *,
    without: Annotated[
        Path | None, typer.Option(help="Photographs that do not bear it.")
    ] = None,
    name: Annotated[str, typer.Option(help="Which known one.")] = "nyc-records",
    write: Annotated[
        Path | None, typer.Option(help="Write it here, measured on all the copies.")
    ] = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Measure a known watermark on half of its copies, and what is left on the rest."""
    with measuring():
        from pipelines.evaluate import watermark

        report = watermark.evaluate(folder, name=name, without=without, write=write)
    tell(report, watermark.text(report), as_json=as_json, quiet=quiet)


@app.command("views")
def views_command(
    folder: Annotated[Path, typer.Argument(help="Holds photos/, labels/, lots.json.")],
    *,
    block: Block = "",
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Measure whether two photographs' views of one front are told to be one."""
    with measuring():
        from pipelines.evaluate import views

        report = views.evaluate(folder, block=block)
    tell(report, views.text(report), as_json=as_json, quiet=quiet)


@app.command("fronts")
def fronts_command(
    data: Annotated[Path, typer.Argument(help="Holds photos/, labels/, lots.json.")],
    city: City,
    *,
    block: Block = "",
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Measure whether facades are told to be the right fronts; wrong ones by name."""
    with measuring():
        from pipelines.evaluate import fronts

        report = fronts.evaluate(data, city, block=block)
    tell(report, fronts.text(report), as_json=as_json, quiet=quiet)


@app.command("borrowed")
def borrowed_command(
    city: Annotated[Path, typer.Argument(help="A finished city.")],
    *,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Sum up what neighbours' photographs lent to each block's fronts."""
    with measuring():
        from pipelines.evaluate import borrowed

        report = borrowed.evaluate(city)
    tell(report, borrowed.text(report), as_json=as_json, quiet=quiet)


@app.command("placards")
def placards_command(
    folder: Annotated[Path, typer.Argument(help="Holds photos/ and labels/.")],
    city: Annotated[Path, typer.Argument(help="A folder to index the photographs in.")],
    *,
    block: Block = "",
    models: ModelsFolder = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Measure whether boards alone lead to the right lots, among ten times as many."""
    with measuring():
        from pipelines.evaluate import placards

        told = str(models or "")
        report = placards.evaluate(folder, city, models=told, block=block)
    tell(report, placards.text(report), as_json=as_json, quiet=quiet)
