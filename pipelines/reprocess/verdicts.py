"""Which of a run's rejections stand, and which a fresh build would try again.

A crash is no verdict: memory or a disk may be there the next time; but after some runs
it is let be (`tries`). What ended its process was put aside, which holds as long as all
versions do. Somebody may ask for both.
"""

from collections.abc import Mapping
from typing import Final, NamedTuple

from pipelines.build import ASIDE, CRASHED
from pipelines.index.asked import short
from pipelines.reprocess.published import Published
from pipelines.reprocess.tries import MOST
from pipelines.store.versions import Versions

STAGES: Final = ("segment", "matte", "rectify")  # of a photograph, in their order
SMALL: Final = "thumbnail"
ORDER: Final = {stage: n for n, stage in enumerate((*STAGES, SMALL))} | {"photo": 0}
OF_BLOCK: Final = ("assign", "block")


class Verdicts(NamedTuple):
    """What was rejected whole, as eight bytes of each name."""

    reached: dict[int, int]  # of photographs: how many stages they passed
    refused: set[int]  # blocks
    again: set[int]  # names, and blocks, that are to be tried again
    left: set[str]  # names, and blocks, that are let be until somebody asks


def verdicts(
    before: Published,
    versions: Versions,
    tries: Mapping[str, int],
    *,
    retry: bool = False,
) -> Verdicts:
    """Read which rejections of a run stand at the versions of now."""
    told = Verdicts({}, set(), set(), set())
    same = before.versions == versions
    columns = ("key", "stage", "reason", "facade")
    for table in before.parts("rejections", *columns):
        whole = table.filter(table.column("facade").is_null())
        cells = (whole.column(one).to_pylist() for one in columns[:3])
        for key, stage, reason in zip(*cells, strict=True):
            if reason in (CRASHED, ASIDE):
                tired = reason == ASIDE or tries.get(key, 0) >= MOST
                if retry or not (same and tired):
                    told.again.add(short(key))
                    continue
                told.left.add(key)
            if stage in ORDER:
                told.reached[short(key)] = ORDER[stage]
            elif stage in OF_BLOCK:
                told.refused.add(short(key))
    return told
