"""What the tables' commands share: options, networks, how a report is told."""

import contextlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import typer

from pipelines.console import Voice, errors, fail

ModelsFolder = Annotated[
    Path | None, typer.Option("--models", help="Folder with other networks.")
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]


@contextlib.contextmanager
def measuring() -> Iterator[None]:
    """Keep to one thread, so that CPU seconds compare; tell what can't be measured."""
    from pipelines.models import Unlocked, one_thread

    one_thread()
    from pipelines.evaluate import Unmeasurable

    try:
        yield
    except (Unmeasurable, Unlocked) as problem:
        raise fail(str(problem)) from problem
    except OSError as problem:
        words = f"{problem.filename}: {problem.strerror}"
        raise fail(f"{words}; name folders that are there and free") from problem


def network(models: Path | None, name: str) -> Any:
    """Load a network, from the package unless another folder is named."""
    from pipelines import models as shelf

    return shelf.Models(str(models or "")).load(name)


def tell(report: Any, text: str, *, as_json: bool, quiet: bool) -> None:
    """Print a report."""
    voice = Voice(errors, quiet=quiet)
    for line in (json.dumps(report, indent=1) if as_json else text).split("\n"):
        voice.echo(line)
