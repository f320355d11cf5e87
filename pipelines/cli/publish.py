"""`nostalgin publish`: a city's site for a web host."""

from pathlib import Path
from typing import Annotated, Final

import typer

from pipelines import plural
from pipelines.console import Quiet, Voice, errors, fail, unwritable

EXAMPLES: Final = """
Examples:

  nostalgin publish city public
"""


def publish_command(
    city: Annotated[Path, typer.Argument(help="The city folder, or its site.")],
    folder: Annotated[Path, typer.Argument(help="A new folder, or one it made.")],
    *,
    quiet: Quiet = False,
) -> None:
    """Copy the city's site to a folder that any web host can serve.

    Only what the current city needs is copied; files of others are left alone.
    """
    from pipelines.publish import publish
    from pipelines.site import Foreign
    from pipelines.view import NoSiteError

    try:
        done = publish(city, folder)
    except (NoSiteError, Foreign) as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise unwritable(folder, problem) from problem
    voice = Voice(errors, quiet=quiet)
    voice.echo(f"{plural.of(done.files, 'file')}, {done.size:,} bytes: {done.folder}")
    voice.echo("copy them to any web host: they need no server program, and no build")
    voice.echo(f"to try it: nostalgin view {done.folder}")
