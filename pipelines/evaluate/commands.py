"""`nostalgin evaluate`: the paper's tables on folders of labelled photographs.

Each subcommand prints one report, as tables for people or, with `--json`, as JSON.
What is measured is told in the module of the same name beside this one.
"""

import typer

app = typer.Typer(
    help="Measure a stage against labelled data.",
    no_args_is_help=True,
    add_completion=False,
)


@app.callback()
def evaluate() -> None:
    """Measure a stage against labelled data."""
