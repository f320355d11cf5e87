"""Which of a run's rejections stand, and which a fresh build would try again.

A crash is no verdict: memory or a disk may be there the next time. What ended its
process was put aside, which holds as long as all versions do.
"""

from typing import Final, NamedTuple

from pipelines.build import ASIDE, CRASHED
from pipelines.index.asked import short
from pipelines.reprocess.published import Published
from pipelines.store.versions import Versions

STAGES: Final = ("segment", "matte", "rectify")  # of a photograph, in their order
ORDER: Final = {stage: n for n, stage in enumerate(STAGES)} | {"photo": 0}
OF_BLOCK: Final = ("assign", "block")


class Verdicts(NamedTuple):
    """What was rejected whole, as eight bytes of each name."""

    reached: dict[int, int]  # of photographs: how many stages they passed
    refused: set[int]  # blocks
    again: set[int]  # names, and blocks, that are to be tried again


def verdicts(before: Published, versions: Versions) -> Verdicts:
    """Read which rejections of a run stand at the versions of now."""
    told = Verdicts({}, set(), set())
    passing = {CRASHED} if before.versions == versions else {CRASHED, ASIDE}
    columns = ("key", "stage", "reason", "facade")
    for table in before.parts("rejections", *columns):
        whole = table.filter(table.column("facade").is_null())
        cells = (whole.column(one).to_pylist() for one in columns[:3])
        for key, stage, reason in zip(*cells, strict=True):
            if reason in passing:
                told.again.add(short(key))
            elif stage in ORDER:
                told.reached[short(key)] = ORDER[stage]
            elif stage in OF_BLOCK:
                told.refused.add(short(key))
    return told
