"""Options that every command has, whichever room it stands in."""

from typing import Annotated

import typer

Quiet = Annotated[
    bool, typer.Option("--quiet", "-q", help="Tell nothing but what went wrong.")
]
