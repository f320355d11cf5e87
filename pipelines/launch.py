"""What `build` and `demo` share: options are checked, a build runs, its end is told."""

import logging
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import typer

from pipelines.console import Voice, Watch, errors, fail, hushed, summed, unwritable

if TYPE_CHECKING:  # both are slow to load
    from apache_beam.options.pipeline_options import PipelineOptions

    from pipelines.build import Report


def told(
    city: str, *, models: str = "", shard: str = "", beam: Sequence[str] = ()
) -> "PipelineOptions":
    """Gather a build's options; one that makes no sense is wrong usage."""
    from pipelines.models import one_thread

    one_thread()
    logging.getLogger().setLevel(logging.ERROR)  # Beam warns while it is imported
    from pipelines import build

    try:
        return build.options(city, models=models, shard=shard, beam=beam)
    except ValueError as problem:
        raise typer.BadParameter(str(problem)) from problem


def built(city: str, voice: Voice, **asked: Any) -> "Report":
    """Build a city, and tell what came of it or what went wrong."""
    options = told(city, **asked)
    from pipelines import build
    from pipelines.index.manifest import Unusable
    from pipelines.models import Unlocked
    from pipelines.site import Foreign, ViewerMissingError

    try:
        with hushed(errors):
            report = build.build(options, tell=voice.say, watch=partial(Watch, voice))
    except (Unusable, Unlocked, build.Lost, Foreign, ViewerMissingError) as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        raise unwritable(city, problem) from problem
    summed(report, voice)
    return report
