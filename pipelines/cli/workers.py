"""`nostalgin workers`: processes for a runner that does not start its own."""

from typing import Annotated, Final

import typer

from pipelines.console import Quiet, fail

EXAMPLES: Final = """
Examples:

  nostalgin workers                   [dim]# beside a runner on this machine[/]

  nostalgin build city --runner PortableRunner --job_endpoint localhost:8073
      --environment_type EXTERNAL --environment_config localhost:50000
"""


def workers_command(
    port: Annotated[int, typer.Option(min=1, max=65535)] = 50000,
    host: Annotated[
        str, typer.Option(help="Whoever reaches it can run programs here.")
    ] = "localhost",
    *,
    quiet: Quiet = False,
) -> None:
    """Start workers for Prism, Flink or another of Beam's runners, when it asks."""
    del quiet  # they tell nothing else, ever
    from pipelines import build

    try:
        build.serve(host, port)
    except OSError as problem:
        raise fail(str(problem)) from problem
