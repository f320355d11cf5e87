"""The program `nostalgin`: its commands, and where they begin."""

from importlib.metadata import version
from typing import Annotated, Any, Final

import typer

from pipelines.cli import (
    build,
    check,
    corrections,
    demo,
    explain,
    export,
    gc,
    index,
    publish,
    report,
    reprocess,
    review,
    schedule,
    status,
    view,
    watermark,
    workers,
)
from pipelines.console import echo, opened_streams
from pipelines.evaluate import commands

TO_BEAM: Final[dict[str, Any]] = {
    "allow_extra_args": True,
    "ignore_unknown_options": True,
}

app = typer.Typer(
    name="nostalgin",
    help="Turn historical street photographs into a city to walk through.",
    no_args_is_help=True,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
)


def told_version(wanted: bool) -> None:  # noqa: FBT001 - typer's callback
    """Tell the version, and end."""
    if wanted:
        echo(f"nostalgin {version('nostalgin')}")
        raise typer.Exit


@app.callback()
def nostalgin(
    *,
    wanted: Annotated[
        bool,
        typer.Option(
            "--version", callback=told_version, is_eager=True, help="Tell the version."
        ),
    ] = False,
) -> None:
    """Turn historical street photographs into a city to walk through."""


# In this order `--help` lists them.
app.command("explain", epilog=explain.EXAMPLES)(explain.explain_command)
app.command("explain-front")(explain.explain_front_command)
app.command("index", epilog=index.EXAMPLES, context_settings=TO_BEAM)(
    index.index_command
)
app.command("check", epilog=check.EXAMPLES)(check.check_command)
app.command("corrections", epilog=corrections.EXAMPLES)(corrections.corrections_command)
app.command("review", epilog=review.EXAMPLES)(review.review_command)
app.command("watermark", epilog=watermark.EXAMPLES)(watermark.watermark_command)
app.command("build", epilog=build.EXAMPLES, context_settings=TO_BEAM)(
    build.build_command
)
app.command("publish", epilog=publish.EXAMPLES)(publish.publish_command)
app.command("view", epilog=view.EXAMPLES)(view.view_command)
app.command("export", epilog=export.EXAMPLES)(export.export_command)
app.command("demo", epilog=demo.EXAMPLES, context_settings=TO_BEAM)(demo.demo_command)
app.command("reprocess", epilog=reprocess.EXAMPLES, context_settings=TO_BEAM)(
    reprocess.reprocess_command
)
app.command("schedule", epilog=schedule.EXAMPLES, context_settings=TO_BEAM)(
    schedule.schedule_command
)
app.command("report", epilog=report.EXAMPLES)(report.report_command)
app.command("status", epilog=status.EXAMPLES)(status.status_command)
app.command("gc", epilog=gc.EXAMPLES)(gc.gc_command)
app.command("workers", epilog=workers.EXAMPLES)(workers.workers_command)
app.add_typer(commands.app, name="evaluate")


def main() -> None:
    """Run the command line."""
    opened_streams()
    app()
