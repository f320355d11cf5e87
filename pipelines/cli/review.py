"""`nostalgin review`: a page on which people see what was read, and correct it."""

from pathlib import Path
from typing import Annotated, Final

import typer

from pipelines.console import Quiet, Voice, errors, fail, unwritable

EXAMPLES: Final = """
Examples:

  nostalgin review city                       [dim]# writes city/review.html[/]

  nostalgin review city --block 993 --most 50 -o page.html
"""


def review_command(
    city: Annotated[Path, typer.Argument(help="The city folder.")],
    *,
    out: Annotated[
        Path | None, typer.Option("-o", "--out", help="The page; else review.html.")
    ] = None,
    block: Annotated[
        list[str] | None, typer.Option(help="Show this block alone; may be repeated.")
    ] = None,
    most: Annotated[
        int, typer.Option(min=1, help="Photographs on the page, the doubtful first.")
    ] = 200,
    quiet: Quiet = False,
) -> None:
    """Write a page to look over: boards and their readings, findings, fronts as found.

    It is one file that needs no network: corners and outlines are dragged there, fields
    filled in, and it saves corrections.jsonl, to be put into the city folder.
    """
    from pipelines import review
    from pipelines.index import of_folder
    from pipelines.index.manifest import Unusable
    from pipelines.store import Store

    target = out or city / "review.html"
    try:
        found = review.review(Store(str(city)), blocks=block or (), most=most)
    except (Unusable, review.Unkept) as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise fail(f"{city}: {problem.strerror or problem}") from problem
    text = review.page(found, title=of_folder(city.resolve().name))
    try:
        target.write_text(text, encoding="utf-8", errors="replace")
    except OSError as problem:
        raise unwritable(target, problem) from problem
    words = f"see {target}: {len(found.pictures)} photographs"
    more = f", {found.left_out} more left out" if found.left_out else ""
    voice = Voice(errors, quiet=quiet)
    voice.say("done", f"{words}{more}", page=str(target))
