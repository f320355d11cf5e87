"""`nostalgin view`: a city in a browser."""

from pathlib import Path
from typing import Annotated, Final

import typer

from pipelines.console import Quiet, fail, unreadable

EXAMPLES: Final = """
Examples:

  nostalgin view city

  nostalgin view city --port 8000 --no-browser
"""


def view_command(
    city: Annotated[Path, typer.Argument(help="The city folder, or its site.")],
    *,
    port: Annotated[
        int,
        typer.Option(min=0, max=65535, help="Port on this machine; 0 takes any."),
    ] = 0,
    browser: Annotated[bool, typer.Option(help="Open a browser.")] = True,
    quiet: Quiet = False,
) -> None:
    """Serve the city to this machine alone and open it in a browser."""
    from pipelines.view import NoSiteError, site_of, view

    try:
        site = site_of(city)
    except NoSiteError as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise unreadable(city, problem) from problem
    try:
        view(site, port=port, browser=browser, announced=not quiet)
    except OSError as problem:
        raise fail(f"port {port}: {problem.strerror}; take another") from problem
