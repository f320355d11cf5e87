"""What talks to a person: lines, progress, errors and their remedies, examples.

In: events, counts, exceptions. Out: a terminal's lines, or JSON for machines.
It knows what there is to tell; none of those who tell know it. Open `voice` first.
"""

from pipelines.console.alike import folded
from pipelines.console.failure import (
    echo,
    errors,
    fail,
    opened_streams,
    unreadable,
    unwritable,
)
from pipelines.console.hush import hushed
from pipelines.console.options import Quiet
from pipelines.console.progress import Watch
from pipelines.console.voice import Voice, indexed, laid_out, summed

__all__ = [
    "Quiet",
    "Voice",
    "Watch",
    "echo",
    "errors",
    "fail",
    "folded",
    "hushed",
    "indexed",
    "laid_out",
    "opened_streams",
    "summed",
    "unreadable",
    "unwritable",
]
