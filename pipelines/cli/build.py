"""`nostalgin build`: a manifest becomes a city."""

from typing import Annotated, Final

import typer

from pipelines.cli.launch import (
    TOO_MANY_REJECTIONS,
    JsonLines,
    ModelsFolder,
    Retry,
    built,
)
from pipelines.console import Quiet, Voice, errors

EXAMPLES: Final = """
Examples:

  nostalgin build city                            [dim]# in this process[/]

  nostalgin build city --direct_num_workers 2     [dim]# two processes[/]

  nostalgin build city --shard 3/16               [dim]# every sixteenth block[/]

  nostalgin build city --runner FlinkRunner --flink_master host:8081
"""

Schemes = Annotated[
    list[str] | None,
    typer.Option(help="Let the manifest's roots be gs://... ; may be repeated."),
]
MaxRejected = Annotated[
    float,
    typer.Option(
        min=0, max=1, help="Share of photos that may give nothing; above it, exit 3."
    ),
]
PublishAnyway = Annotated[
    bool, typer.Option("--publish-anyway", help="Replace a site that shows more, too.")
]
Webp = Annotated[
    bool, typer.Option("--webp/--no-webp", help="Textures as WebP, or as PNG.")
]
Seconds = Annotated[
    float,
    typer.Option(
        "--stage-seconds",
        min=0,
        help="A stage's time for a photo; a block may take more.",
    ),
]
Gigabytes = Annotated[
    float, typer.Option("--stage-gigabytes", min=0.5, help="And its memory.")
]


def build_command(
    context: typer.Context,
    city: Annotated[str, typer.Argument(help="The city folder that `index` made.")],
    *,
    shard: Annotated[str, typer.Option(help="Part of the blocks, as 3/16.")] = "",
    models: ModelsFolder = None,
    allow_scheme: Schemes = None,
    max_rejected: MaxRejected = 0.5,
    publish_anyway: PublishAnyway = False,
    retry: Retry = False,
    webp: Webp = True,
    seconds: Seconds = 300.0,
    gigabytes: Gigabytes = 4.0,
    json_lines: JsonLines = False,
    quiet: Quiet = False,
) -> None:
    """Build the city: every photo through every stage, one model a block, the site.

    What was done before is found and kept, so a run that was stopped goes on where it
    was. All other options go to Beam.
    """
    voice = Voice(errors, machine=json_lines, quiet=quiet)
    asked = {"models": str(models or ""), "shard": shard, "schemes": allow_scheme or ()}
    limits = [f"--stage_seconds={seconds}", f"--stage_gigabytes={gigabytes}"]
    flags = ["--retry"] * retry + ["--publish_anyway"] * publish_anyway
    flags += ["--no_webp"] * (not webp)
    report = built(city, voice, **asked, beam=[*context.args, *limits, *flags])
    whole = bool(report.blocks and report.photos)  # what no photo shows is assumed
    poor = report.rejected_share > max_rejected or report.held
    if poor or not (whole or shard):
        raise typer.Exit(TOO_MANY_REJECTIONS)
