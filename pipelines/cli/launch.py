"""What commands share: options, and how a build is checked, run and told."""

import contextlib
import logging
import signal
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from pipelines.console import Voice, Watch, errors, fail, hushed, summed, unwritable
from pipelines.stopping import Stopped, heeded

if TYPE_CHECKING:  # both are slow to load
    from apache_beam.options.pipeline_options import PipelineOptions

    from pipelines.build import Report

TOO_MANY_REJECTIONS: Final = 3

ModelsFolder = Annotated[
    Path | None,
    typer.Option("--models", help="Folder with other networks and their models.lock."),
]
City = Annotated[str, typer.Argument(help="The city folder.")]
Retry = Annotated[
    bool,
    typer.Option(
        "--retry", help="Try again what crashed too often or ended its process."
    ),
]
JsonLines = Annotated[
    bool, typer.Option("--json", help="Tell progress as JSON, a line an event.")
]


def told(
    city: str,
    *,
    models: str = "",
    shard: str = "",
    schemes: Sequence[str] = (),
    beam: Sequence[str] = (),
) -> "PipelineOptions":
    """Gather a build's options; one that makes no sense is wrong usage."""
    from pipelines.models import one_thread

    one_thread()
    logging.getLogger().setLevel(logging.ERROR)  # Beam warns while it is imported
    from pipelines import build

    try:
        ours = {"models": models, "shard": shard, "schemes": schemes}
        return build.options(city, **ours, beam=beam)
    except ValueError as problem:
        raise typer.BadParameter(str(problem)) from problem


def built(city: str, voice: Voice, **asked: Any) -> "Report":
    """Build a city, and tell what came of it or what went wrong."""
    options = told(city, **asked)
    from pipelines import build

    with failing(city):
        report = build.build(options, tell=voice.say, watch=partial(Watch, voice))
    summed(report, voice)
    site = Path(city) / "site"
    shown = not (voice.machine or report.held or asked.get("shard"))
    if shown and (site / "site.json").is_file():  # of a machine, `done` is the last
        voice.say("site", f"the site lies in {site}: nostalgin view {city}")
    return report


@contextlib.contextmanager
def failing(city: str) -> Iterator[None]:
    """Tell what a run ends with in a line, and end with it."""
    from pipelines import build
    from pipelines.index.manifest import Unusable
    from pipelines.models import Unlocked
    from pipelines.site import Foreign, ViewerMissingError
    from pipelines.store import Busy, Damaged

    plain = (Unusable, Unlocked, Foreign, ViewerMissingError, build.Lost, build.Unrun)
    plain = (*plain, Busy, Damaged)
    try:
        with heeded(patient), hushed(errors, plain=(*plain, OSError, Stopped)):
            yield
    except Stopped as problem:
        raise ended(problem) from problem
    except plain as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise unwritable(city, problem) from problem


def patient(number: int) -> None:
    """Tell whoever pressed Ctrl-C what comes of it, and how to end at once."""
    if number == signal.SIGINT:
        words = "ending after what is in flight; press Ctrl-C again to end at once"
        errors.print(words, style="dim")


def ended(why: Stopped) -> typer.Exit:
    """Say that a run was asked to end, and end with the code that tells it."""
    fail(str(why))
    return typer.Exit(why.code)
