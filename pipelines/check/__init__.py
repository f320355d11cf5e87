"""What in a city folder is to be mended before it is built, each with its remedy.

In: a city folder. Out: `Finding`s, by row and kind; nothing is written. Open `check`
first.
"""

from pipelines.check.check import check

__all__ = ["check"]
