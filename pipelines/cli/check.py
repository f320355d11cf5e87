"""`nostalgin check`: what is to be mended before a build."""

from collections import Counter
from typing import Annotated, Final

import typer

from pipelines.cli.launch import TOO_MANY_REJECTIONS, JsonLines
from pipelines.console import Quiet, Voice, errors, fail

MOST: Final = 10  # of a kind, to a reader
EXAMPLES: Final = """
Examples:

  nostalgin check city

  nostalgin check city --no-pictures              [dim]# rows and files alone[/]

  nostalgin check city --strict --json
"""


def check_command(
    city: Annotated[str, typer.Argument(help="The city folder that `index` made.")],
    *,
    pictures: Annotated[
        bool, typer.Option(help="Look for pictures that are the same.")
    ] = True,
    strict: Annotated[
        bool, typer.Option("--strict", help="End with 3 for doubts, too.")
    ] = False,
    json_lines: JsonLines = False,
    quiet: Quiet = False,
) -> None:
    """Look over a city folder: rows, keys, files, copies, rights, streets, widths.

    Each finding names its row and the remedy; nothing is written. Ends with 0 if
    nothing is to be mended, 3 if something is, 1 if the manifest can't be read.
    """
    from pipelines import check
    from pipelines.index.manifest import Unusable
    from pipelines.store import Store

    voice = Voice(errors, machine=json_lines, quiet=quiet)
    try:
        found = check.check(Store(city), pictures=pictures)
    except Unusable as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise fail(f"{city}: {problem.strerror or problem}") from problem
    seen: Counter[str] = Counter()
    for one in found:
        seen[one.kind] += 1
        if voice.machine or seen[one.kind] <= MOST:
            degree = "" if one.grave else " (a doubt)"
            words = f"{one.kind}{degree}: {one.row}: {one.what}: {one.remedy}"
            voice.say("finding", words, **vars(one))
    for kind, count in () if voice.machine else seen.items():
        if count > MOST:
            words = f"{kind}: {count - MOST} more; --json tells all"
            voice.say("more", words)
    grave = sum(one.grave for one in found)
    words = f"{grave} to be mended, {len(found) - grave} doubts"
    voice.say("done", words, grave=grave, doubts=len(found) - grave, kinds=dict(seen))
    if grave or (strict and found):
        raise typer.Exit(TOO_MANY_REJECTIONS)
