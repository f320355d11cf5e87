"""What would be redone, and what that is estimated to cost."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import pyarrow as pa

from pipelines.reprocess.cost import rates
from pipelines.reprocess.now import Now
from pipelines.reprocess.published import Published, published
from pipelines.reprocess.stale import CAUSES, Stale, stale
from pipelines.reprocess.verdicts import SMALL, STAGES

PHOTO_STAGES: Final = (*STAGES, SMALL)
SOME: Final = 5  # of what is left alone, by name


@dataclass(frozen=True)
class Plan:
    """What is stale, what of it is redone this time, and at what cost."""

    now: Now
    before: Published
    stale: Stale
    redone: np.ndarray  # uint64, sorted: names and blocks that are redone
    photos: int  # stale ones that are redone
    later: int  # and that are left for the next time
    blocks: int  # that are looked at again
    blocks_asked: int
    made: dict[str, int]  # artifacts to be made, by stage
    cpu_seconds: float | None = None  # None: no run of the city tells
    seconds: float | None = None

    @property
    def nothing(self) -> bool:
        """Tell whether there is nothing to do."""
        return self.stale.nothing

    @property
    def same_versions(self) -> bool:
        """Tell whether the published run was made by the stages of now."""
        return self.before.versions == self.now.versions

    @property
    def same_small(self) -> bool:
        """Tell whether small pictures that are shown are what they would be now."""
        then = self.before.versions
        return then is not None and then.thumbnail == self.now.versions.thumbnail

    @property
    def all_redone(self) -> bool:
        """Tell whether nothing of the published run stays."""
        known = np.array(sorted(self.stale.side.digests), np.uint64)
        return not self.later and bool(np.isin(known, self.redone).all())

    @property
    def waiting(self) -> np.ndarray:
        """List the names and blocks that are stale, and left for the next time."""
        groups = self.stale.groups
        every = groups.within(np.unique(groups.of(self.stale.nodes)))
        return np.setdiff1d(every, self.redone)

    def rows(self) -> Iterator[pa.Table]:
        """Read the rows that are asked for."""
        return self.now.tables(self.before)

    def expected(self) -> dict[str, Any]:
        """Give what it is estimated to cost, if that is known."""
        if self.cpu_seconds is None:
            return {}
        return {"cpu_seconds": self.cpu_seconds, "seconds": self.seconds}

    @property
    def photos_gone(self) -> int:
        """Count the stale photographs that nobody asks for any more."""
        removed = self.stale.photos[self.stale.causes == CAUSES.index("removed")]
        return len(np.setdiff1d(removed, self.stale.side.names))

    @property
    def blocks_gone(self) -> int:
        """Count the blocks that nobody asks for any more."""
        known = np.array(sorted(self.stale.side.digests), np.uint64)
        return len(np.setdiff1d(self.stale.blocks["rows"], known))

    def told(self) -> dict[str, Any]:
        """Give the plan as plain values."""
        causes = {name: self.stale.count(name) for name in CAUSES}
        blocks = {name: len(one) for name, one in self.stale.blocks.items()}
        return {
            "before": self.before.run,
            "photos": self.photos,
            "photos_asked": self.stale.photos_asked,
            "photos_gone": self.photos_gone,
            "later": self.later,
            "blocks": self.blocks,
            "blocks_asked": self.blocks_asked,
            "blocks_gone": self.blocks_gone,
            "corrections_rejected": self.now.mended.rejected,
            "left_alone": len(self.stale.left),
            "left_alone_first": list(self.stale.left[:SOME]),
            "causes": {name: n for name, n in causes.items() if n},
            "blocks_by_cause": {name: n for name, n in blocks.items() if n},
            "moved": self.stale.moved,
            "made": {name: n for name, n in self.made.items() if n},
            "cpu_seconds": self.cpu_seconds,
            "seconds": self.seconds,
        }


def planned(
    now: Now,
    *,
    budget: int = 0,
    thorough: bool = False,
    retry: bool = False,
    workers: int = 1,
) -> Plan:
    """Find what is stale and choose what is redone: all, or `budget` photographs.

    Blocks that share photographs are redone together, the group whose staleness is
    oldest first; the first is redone even if it has more than the budget.

    Raises:
        Unusable: if the manifest can't be read.
        Damaged: if the published run's tables are.
    """
    before = published(now.store)
    found = stale(now, before, thorough=thorough, retry=retry)
    labels = chosen(found, budget)
    redone = found.groups.within(labels)
    photos = int(np.isin(found.photos, redone).sum())
    known = np.array(sorted(found.side.digests), np.uint64)
    gone = np.setdiff1d(found.blocks["rows"], known)
    made, cpu_s, wall_s = cost(now, found, redone, photos, workers)
    return Plan(
        now,
        before,
        found,
        redone,
        photos,
        len(found.photos) - photos,
        int(np.isin(known, redone).sum() + np.isin(gone, redone).sum()),
        len(known),
        made,
        cpu_s,
        wall_s,
    )


def chosen(found: Stale, budget: int) -> np.ndarray:
    """Choose the groups to redo, the one that is stale longest first."""
    groups = found.groups
    every = np.unique(groups.of(found.nodes))
    if not budget or not len(every):
        return every
    own = groups.of(found.photos)
    at = np.searchsorted(every, own)
    counts = np.bincount(at, minlength=len(every))
    since = np.full(len(every), np.iinfo(np.int64).max)
    np.minimum.at(since, at, found.since_ns)
    since[counts == 0] = 0
    order = np.lexsort((groups.first(every), since))
    taken = np.cumsum(counts[order]) <= budget
    taken |= counts[order] == 0
    taken[np.flatnonzero(counts[order])[:1]] = True
    return np.sort(every[order[taken]])


def cost(
    now: Now, found: Stale, redone: np.ndarray, photos: int, workers: int
) -> tuple[dict[str, int], float | None, float | None]:
    """Estimate artifacts, CPU seconds, and seconds on the clock."""
    anew = np.isin(found.causes, [CAUSES.index("new"), CAUSES.index("changed")])
    mine = np.isin(found.photos, redone)
    share = photos / len(found.photos) if len(found.photos) else 1.0
    known = rates(now.store)
    made = {name: round(n * share) for name, n in found.made.items()}
    count = int((anew & mine).sum())
    for stage in PHOTO_STAGES:
        made[stage] = made.get(stage, 0) + count
    of_photo = dict(known.of_photo) if known else {"inpaint": 1.0}
    for stage, each in of_photo.items():
        made[stage] = made.get(stage, 0) + round(count * each)
    digests = np.array(sorted(found.side.digests), np.uint64)
    made["block"] = int(np.isin(digests, redone).sum())
    if known is None:
        return made, None, None
    cpu_s = known.cpu(made | {"assign": made["block"]})
    return made, round(cpu_s, 1), round(known.clock(cpu_s, max(workers, 1)), 1)
