"""`nostalgin corrections`: what people know better, and what it changed."""

from typing import Annotated, Final

import typer

from pipelines import plural
from pipelines.cli.launch import TOO_MANY_REJECTIONS, JsonLines
from pipelines.console import Quiet, Voice, errors, fail

EXAMPLES: Final = """
Examples:

  nostalgin corrections city                      [dim]# city/corrections.csv[/]

  nostalgin corrections city --json
"""


def corrections_command(
    city: Annotated[str, typer.Argument(help="The city folder that `index` made.")],
    *,
    json_lines: JsonLines = False,
    quiet: Quiet = False,
) -> None:
    """Show a city's corrections, and what each changes; nothing is written.

    They stand in corrections.csv or corrections.jsonl, which `index` never touches and
    `build` obeys; docs/corrections.md describes them. Those that change nothing end it
    with 3.
    """
    from pipelines import corrections
    from pipelines.index import manifest
    from pipelines.index.manifest import Unusable
    from pipelines.store import Store

    voice = Voice(errors, machine=json_lines, quiet=quiet)
    store = Store(city)
    try:
        found = manifest.read(store)
        given = corrections.read(store)
        made = corrections.fitting(corrections.applied(found.rows, given), store)
        made = corrections.measured(made, store)
    except Unusable as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise fail(f"{city}: {problem.strerror or problem}") from problem
    for one in made.changes:
        words = f"{one.row}: {one.what} of {one.subject}: {one.before} -> {one.after}"
        note = f" ({one.note})" if one.note else ""
        text = f"{words}{note}; done again: {one.again}"
        voice.say("correction", text, **vars(one), again=one.again)
    for old, by in given.superseded:
        words = f"{old.row}: {old.what} of {old.subject} is superseded by {by}"
        facts = {"row": old.row, "what": old.what, "subject": old.subject, "by": by}
        voice.say("superseded", words, **facts)
    for why in made.rejections:
        words = f"rejected {why.key}: {why.reason}: {why.detail}"
        facts = {"key": why.key, "reason": why.reason, "detail": why.detail}
        voice.say("rejected", words, **facts)
    count = len(made.changes)
    words = f"{plural.of(count, 'correction')}, {len(made.rejections)} rejected"
    voice.say("done", words, corrections=count, rejected=len(made.rejections))
    if made.rejections:
        raise typer.Exit(TOO_MANY_REJECTIONS)
