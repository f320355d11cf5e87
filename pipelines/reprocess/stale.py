"""What is stale: an anti-join of what is asked for now with what is published and kept.

The work is linear in rows. The driver holds some forty bytes of a row, one part of a
table and one group of rows, and no pixel is opened.
"""

from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from pipelines.index.asked import short
from pipelines.reprocess import sides
from pipelines.reprocess.now import Now
from pipelines.reprocess.photographs import Fate, Shelves, fates, fresh, shelves
from pipelines.reprocess.published import Published
from pipelines.reprocess.sides import Groups, Side, Widths
from pipelines.reprocess.tries import tries
from pipelines.reprocess.verdicts import Verdicts, verdicts

CAUSES: Final = ("new", "changed", "removed", "missing", "version", "moved")
NONE: Final = np.zeros(0, np.uint64)


@dataclass(frozen=True)
class Stale:
    """Photographs and blocks that are not as they should be, each with its cause."""

    photos: np.ndarray  # uint64, their names
    causes: np.ndarray  # of each, as `CAUSES` counts
    since_ns: np.ndarray  # of each: when its file was changed; 0 of the others
    blocks: dict[str, np.ndarray]  # by cause, those that no photograph makes stale
    made: Counter[str]  # artifacts that are missing of photographs that are unchanged
    groups: Groups
    side: Side  # what is asked for now
    moved: bool  # the city's places or title are others
    spoiled: list[str]  # paths of artifacts that are damaged
    photos_asked: int = 0
    cut_before: Mapping[str, Widths] = field(default_factory=dict)  # as `Side.cut`
    crashed: np.ndarray = field(default_factory=lambda: NONE)  # names and blocks
    before: Published = field(repr=False, default=None)  # type: ignore[assignment]
    left: tuple[str, ...] = ()  # names and blocks that crashed too often: let be
    tried: Mapping[str, int] = field(default_factory=dict)  # in how many runs

    def count(self, cause: str) -> int:
        """Count the photographs that are stale for a reason."""
        return int((self.causes == CAUSES.index(cause)).sum())

    @property
    def nothing(self) -> bool:
        """Tell whether all is as it should be."""
        return not (len(self.photos) or self.moved or len(self.nodes))

    @property
    def nodes(self) -> np.ndarray:
        """List the names and blocks that are stale."""
        return np.unique(np.concatenate([self.photos, *self.blocks.values()]))


def stale(
    now: Now, before: Published, *, thorough: bool = False, retry: bool = False
) -> Stale:
    """Find what is stale; `thorough`, with every photograph's bytes read and hashed.

    To `retry` is to try again what crashed too often, or ended its process.

    Raises:
        Unusable: if the manifest can't be read.
        Damaged: if the published run's tables are.
    """
    after = sides.side(now.tables(before), now.store.root, now.mended.told())
    earlier = after
    if before.rows_sha256 != now.rows_sha256:
        earlier = sides.side(before.asked(), now.store.root, before.directed())
    kept = shelves(now.store, now.versions, thorough=thorough)
    tried = tries(now.store, now.versions)
    known = verdicts(before, now.versions, tried, retry=retry)
    found = list_of(photographs(now, before, after, kept, known, thorough=thorough))
    again = np.array(sorted(known.again), np.uint64)
    for name in np.intersect1d(again, after.names).tolist():
        found.add(Fate(0, name, "missing"))
    blocks = {"rows": sides.differing(earlier.digests, after.digests)}
    both = earlier.digests.keys() & after.digests.keys()
    blocks |= unmade(now, before, kept, found, both - known.refused)
    photos, causes, since_ns = found.arrays()
    unique = np.unique(after.ids)
    return Stale(
        photos,
        causes,
        since_ns,
        blocks,
        kept.made,
        sides.groups(earlier, after),
        after,
        moved(now, before),
        kept.spoiled,
        len(unique) - int(bool(len(unique)) and unique[0] == 0),
        earlier.cut,
        again,
        before,
        tuple(sorted(known.left)),
        tried,
    )


class Found:
    """Stale photographs, in numbers."""

    def __init__(self) -> None:
        """Begin with none."""
        self.names: list[int] = []
        self.causes: list[int] = []
        self.since_ns: list[int] = []

    def add(self, one: Fate) -> None:
        """Take a photograph that is stale."""
        self.names.append(one.name)
        self.causes.append(CAUSES.index(one.cause))
        self.since_ns.append(one.since_ns)

    def arrays(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Give names, causes and times, each name once with its first cause.

        What is gone from one folder and new in another was moved.
        """
        every, told = np.array(self.names, np.uint64), np.array(self.causes, np.uint8)
        names, first = np.unique(every, return_index=True)
        gone, come = (every[told == CAUSES.index(one)] for one in ("removed", "new"))
        causes = told[first]
        causes[np.isin(names, np.intersect1d(gone, come))] = CAUSES.index("moved")
        return names, causes, np.array(self.since_ns, np.int64)[first]


def list_of(found: Iterator[Fate]) -> Found:
    """Gather what is stale."""
    gathered = Found()
    for one in found:
        gathered.add(one)
    return gathered


def photographs(
    now: Now,
    before: Published,
    after: Side,
    kept: Shelves,
    known: Verdicts,
    *,
    thorough: bool,
) -> Iterator[Fate]:
    """Tell of the photographs that are stale."""
    asked = np.unique(after.ids)
    asked = asked[asked != 0]
    read = []
    for one in fates(now, before, asked, kept, known.reached, thorough=thorough):
        read.append(one.id)
        if one.cause:
            yield one
    unread = np.setdiff1d(asked, np.array(read, np.uint64))
    yield from fresh(now.tables(before), now.store.root, unread, known.reached)


def unmade(
    now: Now, before: Published, kept: Shelves, found: Found, wanted: Collection[int]
) -> dict[str, np.ndarray]:
    """List blocks whose models, or whose elevations, are missing or of other versions.

    A photograph whose finished elevation is missing, or what neighbours lent to it, is
    stale; a block is, of which it is lost which facades look alike. `wanted` are the
    blocks that then were asked for as now, those apart whose rejection stands.
    """
    if before.versions is None or before.versions != now.versions:
        worn = (len(e) for e in cells(before, "buildings", "elevations"))
        kept.made["inpaint"] += sum(worn) if renewed(now, before, "inpaint") else 0
        blocks = np.array(sorted(wanted), np.uint64)
        blocks = blocks if renewed(now, before, "block") else NONE
        return {"version": blocks, "missing": NONE}
    lost = sorted({*wanted}.difference(map(short, block_names(before))))
    for table in before.parts("buildings", "photos", "elevations"):
        of, paths = (table.column(n).to_pylist() for n in range(2))
        pairs = [
            (n, p)
            for a, b in zip(of, paths, strict=True)
            for n, p in zip(a, b, strict=True)
        ]
        lacking = kept.lacks("inpaint", [path for _, path in pairs])
        for at in np.flatnonzero(lacking):
            found.add(Fate(0, short(pairs[at][0]), "missing"))
        kept.made["inpaint"] += int(lacking.sum())
    for table in before.parts("blocks", "block", "model"):
        of, paths = (table.column(n).to_pylist() for n in range(2))
        lacking = kept.lacks("block", paths)
        lost += [short(of[at]) for at in np.flatnonzero(lacking)]
    for name in lacked(before, kept, "borrow", ("borrowed", "name", "borrowed")):
        found.add(Fate(0, name, "missing"))
    lost += lacked(before, kept, "compare", ("blocks", "block", "compared"))
    return {"version": NONE, "missing": np.array(sorted(lost), np.uint64)}


def lacked(
    before: Published, kept: Shelves, stage: str, column: tuple[str, str, str]
) -> list[int]:
    """List, with repeats, whose artifacts of a stage a table names and are lost.

    `column` is the table, the column of whose they are, and that of lists of artifacts.
    """
    lost: list[int] = []
    for table in before.parts(*column):
        if table.num_columns < 2:
            continue  # of a run that did not name them
        rows = zip(*(one.to_pylist() for one in table.columns), strict=True)
        named = [(of, path) for of, paths in rows for path in paths]
        lacking = kept.lacks(stage, [path for _, path in named])
        lost += [short(named[at][0]) for at in np.flatnonzero(lacking)]
    kept.made[stage] += len(lost)
    return lost


def renewed(now: Now, before: Published, stage: str) -> bool:
    """Tell whether a stage, or one that it builds upon, is of another version."""
    stages = "segment", "matte", "rectify", "compare", "borrow", "inpaint", "block"
    names = stages[: stages.index(stage) + 1]
    return any(
        getattr(before.versions, n, "") != getattr(now.versions, n) for n in names
    )


def block_names(before: Published) -> Iterator[str]:
    """Name the blocks of a run."""
    return cells(before, "blocks", "block")


def cells(before: Published, table: str, column: str) -> Iterator:
    """Read a column part by part."""
    for part in before.parts(table, column):
        yield from part.column(column).to_pylist()


def moved(now: Now, before: Published) -> bool:
    """Tell whether the city is told to lie elsewhere, or to be called otherwise."""
    told_then = (before.told.get("places", ""), before.told.get("title", ""))
    return bool(before.run) and told_then != (now.anchors.sha256, now.there.title)
