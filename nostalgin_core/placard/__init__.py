"""The number board in a tax photograph says which lot it records.

In: a `Photo`, its board among the instances, a reader. Out: a `Placard`, or why not,
and where the board's arrow stands.
Paper: section 3.1 takes block and lot as known. Open `placard` first.
"""

from nostalgin_core.placard.arrow import arrow
from nostalgin_core.placard.placard import board, read

__all__ = ["arrow", "board", "read"]
