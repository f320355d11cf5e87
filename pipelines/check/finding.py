"""One thing to be mended: which row, what is wrong, and the remedy."""

from dataclasses import dataclass


@dataclass(frozen=True, order=True)
class Finding:
    """What is wrong with a row; a `grave` one loses a photograph or shows a wrong."""

    kind: str  # a short fixed phrase that can be counted
    row: str
    what: str
    remedy: str
    grave: bool
