"""`nostalgin demo`: a painted neighbourhood, photographed, rebuilt and shown."""

import os
import sys
from pathlib import Path
from typing import Annotated, Final

import typer

from pipelines.cli.launch import JsonLines, built, told
from pipelines.console import Quiet, Voice, errors, unwritable

MOST_WORKERS: Final = 4  # each holds both networks

EXAMPLES: Final = """
Examples:

  nostalgin demo                                  [dim]# two blocks in demo-city/[/]

  nostalgin demo --blocks 1 --direct_num_workers 2
"""


def demo_command(
    context: typer.Context,
    folder: Annotated[
        Path, typer.Option("-o", "--out", help="Where to put it.")
    ] = Path("demo-city"),
    *,
    blocks: Annotated[int, typer.Option(min=1, max=3, help="How many blocks.")] = 2,
    browser: Annotated[bool, typer.Option(help="Open a browser at the end.")] = True,
    json_lines: JsonLines = False,
    quiet: Quiet = False,
) -> None:
    """Paint a neighbourhood, photograph it, rebuild it from the photos, and show it.

    Without a terminal it prints where the site lies, and ends. All other options go to
    Beam; without any, a process works on each core, up to four.
    """
    from pipelines.models import one_thread

    one_thread()
    from pipelines import index
    from pipelines.demo import CREDIT, TITLE, painted
    from pipelines.view import view

    voice = Voice(errors, machine=json_lines, quiet=quiet)

    def tell(done: int, whole: int) -> None:
        if done % 10 == 0 or done == whole:
            words = f"painted {done} of {whole} photographs"
            voice.say("painted", words, done=done, whole=whole)

    workers = [f"--direct_num_workers={min(os.cpu_count() or 1, MOST_WORKERS)}"]
    beam = context.args or workers
    told(str(folder), beam=beam)  # a mistyped option is told before anything is painted
    try:
        photos, listed = painted(folder, blocks=blocks, tell=tell)
        asked = index.Question(credit=CREDIT, title=TITLE)
        made = index.index(photos, listed, str(folder), asked, force=True)
    except OSError as problem:
        raise unwritable(folder, problem) from problem
    for warning in made.warnings:
        voice.say("warning", f"warning: {warning}", warning=warning)
    built(str(folder), voice, beam=beam)
    if browser and sys.stdout.isatty():
        view(folder, announced=not quiet)
