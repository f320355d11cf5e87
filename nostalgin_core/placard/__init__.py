"""The number board in a tax photograph says which lot it records.

In: a `Photo`, its board among the instances, a reader. Out: a `Placard`, or why not,
and where the board's arrow stands; for a list's keys, the `Joined` one that several
looks most probably show, and what it says beside the file's name and the list.
Paper: section 3.1 takes block and lot as known. Open `placard` first, then `joined`.
"""

from nostalgin_core.placard.arrow import arrow
from nostalgin_core.placard.joined import Joined, Keys, Look, around, joined, known
from nostalgin_core.placard.looks import Sight, crop, looked
from nostalgin_core.placard.misread import Key
from nostalgin_core.placard.placard import board, read
from nostalgin_core.placard.respelt import respelt
from nostalgin_core.placard.witness import VERDICTS, Judged, Verdict, judge

__all__ = [
    "VERDICTS",
    "Joined",
    "Judged",
    "Key",
    "Keys",
    "Look",
    "Sight",
    "Verdict",
    "around",
    "arrow",
    "board",
    "crop",
    "joined",
    "judge",
    "known",
    "looked",
    "read",
    "respelt",
]
