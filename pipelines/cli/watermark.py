"""`nostalgin watermark`: learn an archive's own watermark from copies that bear it."""

from pathlib import Path
from typing import Annotated, Final

import typer

from pipelines.console import Quiet, Voice, errors, fail, unwritable

EXAMPLES: Final = """
Examples:

  nostalgin watermark copies -o watermark.npz --words "Archive of Arles"

  nostalgin index copies --profile arles.toml -o city    [dim]# which names it[/]
"""


def watermark_command(
    photos: Annotated[Path, typer.Argument(help="A folder of 20 copies or more.")],
    out: Annotated[Path, typer.Option("-o", "--out", help="File to write, .npz.")],
    *,
    words: Annotated[
        str, typer.Option(help="What the watermark says: it joins the credit.")
    ],
    quiet: Quiet = False,
) -> None:
    """Learn the watermark that an archive lays over its copies, again and again.

    Tells how sure it is, draws it and what it leaves beside the file as a PNG, and ends
    with 1 where the photographs share none. A profile names the file: docs/placards.md.
    """
    from pipelines.models import one_thread

    one_thread()
    import cv2

    from pipelines.index import Nothing, learning

    if out.suffix != ".npz" or not words.strip():
        raise fail(f"{out}: name a file that ends in .npz, and --words that it says")
    try:
        found, looked = learning.learnt(photos, words.strip())
    except Nothing as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise fail(f"{photos}: {problem.strerror or problem}") from problem
    if found.mark is None:
        raise fail(f"{photos}: these photographs share no watermark: {found.why}")
    data, mark = learning.written(found.mark)
    drawn = cv2.imencode(".png", learning.sheet(mark, looked))[1].tobytes()
    try:
        out.write_bytes(data)
        out.with_suffix(".png").write_bytes(drawn)
    except OSError as problem:
        raise unwritable(str(out), problem) from problem
    across, down = mark.step
    voice = Voice(errors, quiet=quiet)
    voice.echo(
        f"it repeats every {across:.4f} by {down:.4f} of the width; two halves' "
        f"tiles correlate by {found.agreement:.2f}, and each is found in the other's: "
        f"{found.borne} of {found.photos} photographs"
    )
    voice.echo(f"see {out.with_suffix('.png')}; name {out.name} in a profile")
