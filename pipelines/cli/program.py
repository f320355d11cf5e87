"""The program `nostalgin`: its commands, and where they begin."""

from typing import Any, Final

import typer

from pipelines.cli import build, demo, explain, gc, index, view, workers
from pipelines.console import opened_streams
from pipelines.evaluate import commands

TO_BEAM: Final[dict[str, Any]] = {
    "allow_extra_args": True,
    "ignore_unknown_options": True,
}

app = typer.Typer(
    name="nostalgin",
    help="Turn historical street photographs into a city to walk through.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
)


@app.callback()
def nostalgin() -> None:
    """Turn historical street photographs into a city to walk through."""


# In this order `--help` lists them.
app.command("explain", epilog=explain.EXAMPLES)(explain.explain_command)
app.command("index", epilog=index.EXAMPLES)(index.index_command)
app.command("build", epilog=build.EXAMPLES, context_settings=TO_BEAM)(
    build.build_command
)
app.command("view", epilog=view.EXAMPLES)(view.view_command)
app.command("demo", epilog=demo.EXAMPLES, context_settings=TO_BEAM)(demo.demo_command)
app.command("gc", epilog=gc.EXAMPLES)(gc.gc_command)
app.command("workers", epilog=workers.EXAMPLES)(workers.workers_command)
app.add_typer(commands.app, name="evaluate")


def main() -> None:
    """Run the command line."""
    opened_streams()
    app()
