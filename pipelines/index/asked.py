"""What a run is asked for: the manifest's rows, checked, where any worker reads them.

    CITY/runs/<run id>/asked.parquet      a row each, or why it can't be used

A manifest may be mended while a run is at work, and may have more rows than one process
should hold: so each run keeps its own copy, written and read in groups of rows.
"""

import hashlib
from array import array
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain, pairwise
from typing import Any, Final

import numpy as np
import pyarrow as pa

from nostalgin_core.records import Front, Rejection
from pipelines.index import manifest
from pipelines.index.cells import text
from pipelines.index.plan import falls_to, homeless
from pipelines.index.roots import rooted, screened
from pipelines.index.row import Refused, Row, contradictions
from pipelines.index.source import Source
from pipelines.store import Store, runs, tables

ASKED: Final = "asked"
GROUP: Final = 4096  # rows that a worker reads at a time
PIECES: Final = 256  # at most, however many rows: they are part of a pipeline's graph
WHY: Final = tables.schema(Rejection)
SAID: Final = pa.schema([pa.field(name, pa.string()) for name in manifest.TOLD])
NUMBER: Final = pa.field("number", pa.int64())
COLUMNS: Final = pa.schema([NUMBER, *manifest.SCHEMA, *SAID, *WHY])

Warn = Callable[[str], None]
Piece = tuple[int, int]  # row groups: the first, and the one after the last
Shard = tuple[int, int]


@dataclass(frozen=True)
class Asked:
    """How much a run is asked for, and where that is written."""

    run: str
    photos: int
    blocks: int
    groups: int  # of rows
    rows: int  # those that can't be used among them
    title: str = ""
    first: Rejection | None = None  # of the rows that can't be used
    unplaced: int = 0  # photos that only rows name that can't be used

    def pieces(self) -> list[Piece]:
        """Part the rows into at most `PIECES`, each some groups in a row."""
        ends = sorted({self.groups * n // PIECES for n in range(PIECES + 1)})
        return list(pairwise(ends))


def ask(
    store: Store,
    there: Source,
    run: str,
    *,
    schemes: Sequence[str] = (),
    shard: Shard = (1, 1),
    warn: Warn = lambda _: None,
    results: Iterable[Row | Refused] | None = None,
) -> Asked:
    """Check a manifest's rows and write those that fall to a shard beside its tables.

    `results` are rows in place of the manifest's own.

    Raises:
        Unusable: if the manifest can't be read to its end.
        OSError: if the folder can't be written to.
    """
    for line in manifest.noticed(there):
        warn(line)
    sorting = Sorting(store.root, schemes, shard, warn)
    cells = (one for batch in there.batches() for one in batch)
    checked = manifest.checked(cells) if results is None else results
    groups, count = written(store, run, told_as(sorting.each(checked)))
    photos, blocks = sorting.photos.count(), sorting.blocks.count()
    told = (there.title, sorting.first, sorting.unplaced.beyond(sorting.photos))
    return Asked(run, photos, blocks, groups, count, *told)


def told_as(results: Iterable[Row | Refused]) -> Iterator[pa.Table]:
    """Write rows as tables of `GROUP` rows."""
    for group in grouped(map(cells_of, results)):
        yield pa.Table.from_pylist(group, COLUMNS)


def written(store: Store, run: str, groups: Iterable[pa.Table]) -> tuple[int, int]:
    """Write what a run is asked for; tell how many groups and rows these are."""
    count = size = 0

    def counted() -> Iterator[pa.Table]:
        nonlocal count, size
        for table in groups:
            count, size = count + 1, size + table.num_rows
            yield table

    store.write_groups(runs.table_path(run, ASKED), COLUMNS, counted())
    return count, size


class Distinct:
    """Counts different texts by eight bytes each: a million share none."""

    def __init__(self) -> None:
        """Begin with none."""
        self._seen = array("Q")

    def add(self, *parts: str) -> None:
        """Count a text, given in parts."""
        self._seen.append(short(*parts))

    def count(self) -> int:
        """Tell how many there are."""
        return len(self.each())

    def beyond(self, others: "Distinct") -> int:
        """Tell how many there are that are none of the others."""
        return len(np.setdiff1d(self.each(), others.each(), assume_unique=True))

    def each(self) -> np.ndarray:
        """Give their hashes, each once."""
        return np.unique(np.frombuffer(self._seen, np.uint64))


@dataclass
class Sorting:
    """Sorts a manifest's rows into those to work on and those that can't be."""

    city: str
    schemes: Sequence[str]
    shard: Shard
    warn: Warn
    photos: Distinct = field(default_factory=Distinct)
    blocks: Distinct = field(default_factory=Distinct)
    unplaced: Distinct = field(default_factory=Distinct)
    first: Rejection | None = None

    def each(self, results: Iterable[Row | Refused]) -> Iterator[Row | Refused]:
        """Pass on the rows of the shard, and why others can't be used.

        Rows of one block that follow one another are looked at together: `index` puts
        them in that order, and so does a build that finds them mended.
        """
        together: list[Row] = []
        for one in chain(results, [None]):
            row = placed(one and screened(one, self.city, self.schemes))
            if isinstance(row, Refused):
                self.first = row.why if self.first is None else self.first
                if row.photo:
                    self.unplaced.add(rooted(row.root, self.city), row.photo)
                yield row
                continue
            if together and (row is None or block_of(row) != block_of(together[0])):
                for told in contradictions(together):
                    self.warn(told)
                together = []
            if row is None:
                return
            together.append(row)
            if falls_to(block_of(row), self.shard):
                self.blocks.add(block_of(row))
                if row.photo:
                    self.photos.add(rooted(row.root, self.city), row.photo)
                yield row


def placed(row: Row | Refused | None) -> Row | Refused | None:
    """Refuse a row whose photo has no place."""
    if isinstance(row, Row) and row.front is None:
        return Refused(homeless(row), row.root, row.photo)
    return row


def block_of(row: Row) -> str:
    """Name the block of a row that has a front."""
    return row.front.block if row.front is not None else ""


def short(*parts: str) -> int:
    """Hash a text, given in parts, to eight bytes."""
    joined = "\0".join(parts).encode(errors="surrogateescape")
    return int.from_bytes(hashlib.blake2b(joined, digest_size=8).digest(), "big")


def rows(
    store: Store, run: str, piece: Piece | None = None
) -> Iterator[Row | Rejection]:
    """Read what a run was asked for, or a piece of it, row by row.

    Raises:
        Damaged: if it is not what was written.
    """
    for table in store.read_groups(runs.table_path(run, ASKED), piece):
        for cells in table.to_pylist():
            if cells["reason"] is not None:
                yield tables.from_row(Rejection, cells)
                continue
            own = {name: cells[name] for name in ("number", "root", "photo", "credit")}
            said = {name: cells[name] for name in SAID.names if cells[name]}
            yield Row(**own, front=tables.from_row(Front, cells), cells=said)


def cells_of(row: Row | Refused) -> dict[str, Any]:
    """Write a row that `rows` reads back."""
    if isinstance(row, Refused):
        return {"root": row.root, "photo": row.photo} | tables.to_row(row.why)
    told = manifest.row_of(row.photo, row.front, root=row.root, credit=row.credit)
    said = {name: text(row.cells, name) for name in SAID.names}
    return {"number": row.number} | told | {n: word for n, word in said.items() if word}


def grouped(rows: Iterable[Any]) -> Iterator[list[Any]]:
    """Part rows into groups of `GROUP`."""
    group: list[Any] = []
    for one in rows:
        group.append(one)
        if len(group) == GROUP:
            yield group
            group = []
    if group:
        yield group
