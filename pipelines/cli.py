"""The command line: `nostalgin demo | index | build | view | explain`.

Exit codes: 0 done, 1 failed, 2 wrong usage, 3 done with more rejections than allowed.
Beam and the networks are imported by the commands that need them, so that `--help`
answers at once.
"""

import sys
import time
from pathlib import Path
from typing import Annotated, Final

import typer
from rich.console import Console

FAILED: Final = 1
TOO_MANY_REJECTIONS: Final = 3

app = typer.Typer(
    name="nostalgin",
    help="Turn historical street photographs into a city to walk through.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
)
errors = Console(stderr=True, highlight=False, soft_wrap=True)

ModelsFolder = Annotated[
    Path | None,
    typer.Option("--models", help="Folder with other networks and their models.lock."),
]


@app.callback()
def nostalgin() -> None:
    """Turn historical street photographs into a city to walk through."""


def fail(message: str) -> typer.Exit:
    """Say on standard error what went wrong and how to mend it."""
    errors.print("[bold red]error:[/] ", end="")
    errors.print(message, markup=False)
    return typer.Exit(FAILED)


EXPLAIN_EXAMPLES = """
Examples:

  nostalgin explain photo.jpg -o out         [dim]# pictures and explain.json in out/[/]

  nostalgin explain photo.jpg -o out --no-placard
"""


@app.command("explain", epilog=EXPLAIN_EXAMPLES)
def explain_command(
    photo: Annotated[Path, typer.Argument(help="The photograph.")],
    out: Annotated[Path, typer.Option("-o", "--out", help="Folder to write to.")],
    *,
    placard: Annotated[
        bool, typer.Option(help="Read the number board in the photo.")
    ] = True,
    models: ModelsFolder = None,
) -> None:
    """Take one photo through every stage and show what each made of it.

    Writes every stage as a PNG, the stages side by side as panel.png, and their numbers
    as explain.json. The file's name is never looked at.
    """
    started = time.process_time()
    from pipelines.models import one_thread

    one_thread()
    from pipelines import models as shelf
    from pipelines.explain import Unreadable, explain

    try:
        data = photo.read_bytes()
    except OSError as problem:
        raise fail(f"{photo}: {problem.strerror}; name an image file") from problem
    try:
        networks = shelf.Models(str(models or shelf.PACKAGED)).networks(placard=placard)
        report = explain(data, out, networks, started=started)
    except (Unreadable, FileNotFoundError, shelf.Unlocked) as problem:
        raise fail(f"{photo}: {problem}") from problem
    targets = sum(one["target"] for one in report["facades"])
    typer.echo(
        f"{len(report['facades'])} facades ({targets} target), "
        f"{len(report['occluders'])} occluders, {report['seconds']['total']:.1f} CPU s"
    )
    for one in report["rejections"]:
        which = f" facade {one['facade']}" if one.get("facade") is not None else ""
        typer.echo(f"rejected{which}: {one['stage']}: {one['reason']}: {one['detail']}")
    typer.echo(f"see {out / 'panel.png'} and {out / 'explain.json'}")


def main() -> None:
    """Run the command line."""
    app()


if __name__ == "__main__":
    sys.exit(main())
