"""The manifest: which photo shows which fronts, a row for each pair of the two.

`index` writes it twice, as `manifest.parquet` for programs and `manifest.csv` for
people. The Parquet file remembers the hash of the CSV it was written with, so a CSV
that was mended by hand is noticed, and wins; it keeps the city's title, too. Columns
are documented in `docs/manifest.md`; columns that are not known are kept.
"""

import contextlib
import hashlib
import io
import json
import time
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import islice
from typing import Any, Final

import pyarrow as pa
import pyarrow.parquet as pq

from nostalgin_core.records import Front, Rejection
from pipelines.index import comma, source, told
from pipelines.index.cells import text
from pipelines.index.row import CSV, Refused, Row, contradictions, usable
from pipelines.index.source import (
    COMING,
    CSV_HASH,
    KEPT,
    PARQUET,
    TITLE,
    Source,
    Unusable,
)
from pipelines.store import Store, tables

MENDED: Final = b"nostalgin.mended"  # by hand, at some time since `index` wrote it
PHOTO: Final = pa.schema(
    [
        pa.field("root", pa.string()),  # folder that `photo` is relative to
        pa.field("photo", pa.string()),  # empty: a front without a photo
        pa.field("credit", pa.string()),
    ]
)
FRONT: Final = tables.schema(Front)
SCHEMA: Final = pa.schema([*PHOTO, *FRONT])
REQUIRED: Final = ("photo", "front_id", "block", "lot")
# Columns that a list may tell of a photograph, and one of a building; none stands where
# nothing is told.
TOLD: Final = (*told.TOLD, told.AS_WRITTEN, "year")
DIGITS: Final = 9
GROUP: Final = 4096  # rows that are written at a time
FIRST_ROW: Final = 2  # as a spreadsheet counts: the header is row 1


@dataclass(frozen=True)
class Manifest:
    """The rows that can be used, those that can't, and what else was noticed."""

    rows: tuple[Row, ...]
    rejections: tuple[Rejection, ...]
    warnings: tuple[str, ...]
    sha256: str  # of what was read
    mended: bool = False  # the CSV was edited since it was written
    title: str = ""  # of the city; empty: its folder's name will do
    kept: tuple[str, ...] = ()  # columns that `index` took from a list


def row_of(
    photo: str, front: Front | None, *, root: str, credit: str
) -> dict[str, Any]:
    """Write a row's cells."""
    cells = dict.fromkeys(FRONT.names) if front is None else tables.to_row(front)
    return {"root": root, "photo": photo, "credit": credit} | cells


def write(
    store: Store,
    rows: Iterable[dict[str, Any]],
    *,
    title: str = "",
    mended: bool = False,
    kept: Collection[str] | None = (),
) -> None:
    """Write the manifest in both forms, as `encoded` does."""
    put(store, encoded(rows, title=title, mended=mended, kept=kept))


def put(store: Store, both: tuple[bytes, bytes]) -> None:
    """Write a manifest's two forms, as they are encoded.

    Whenever it is killed, the old or the new manifest is there, and neither is taken
    for one that was mended by hand.
    """
    csv, parquet = both
    store.write_bytes(COMING, parquet)
    store.write_bytes(CSV, csv)
    store.write_bytes(PARQUET, parquet)
    store.remove(COMING)


def encoded(
    rows: Iterable[dict[str, Any]],
    *,
    title: str = "",
    mended: bool = False,
    kept: Collection[str] | None = (),
) -> tuple[bytes, bytes]:
    """Encode the manifest as CSV and Parquet, by block, ring, rank and photo.

    Rows may be made one at a time: none is held, for a million take a gigabyte as
    Python has them. `kept` are columns of a list, which are remembered to be none of a
    slip's; None: all that are not the manifest's own.
    """
    table, sink = ordered(rows), io.BytesIO()
    sink.write(comma.lines([table.column_names]).encode())
    for batch in table.to_batches(GROUP):
        cells = (column.to_pylist() for column in batch)
        sink.write(comma.lines(zip(*cells, strict=True)).encode())
    text = sink.getvalue()
    mark = {CSV_HASH: hashlib.sha256(text).hexdigest().encode()}
    if title:
        mark[TITLE] = title.encode()
    if mended:
        mark[MENDED] = b"yes"
    if kept is None:
        kept = {*table.column_names} - {*SCHEMA.names}
    if kept:
        mark[KEPT] = json.dumps(sorted(kept)).encode()
    return text, tables.parquet_bytes(table.replace_schema_metadata(mark))


def ordered(rows: Iterable[dict[str, Any]]) -> pa.Table:
    """Put rows into a table, in their order; columns not known come last."""
    table, keys = gathered(rows)
    order = pa.array(sorted(range(len(keys)), key=keys.__getitem__), pa.int64())
    del keys  # as large as the table
    others = sorted({*table.column_names} - {*SCHEMA.names})
    return table.select([*SCHEMA.names, *others]).take(order).combine_chunks()


def gathered(rows: Iterable[dict[str, Any]]) -> tuple[pa.Table, list[tuple[Any, ...]]]:
    """Put rows into a table as they come, and tell their places."""
    keys, groups, waiting = [], [SCHEMA.empty_table()], iter(rows)
    while group := list(islice(waiting, GROUP)):
        keys += map(place, group)
        others = sorted({name for row in group for name in row} - {*SCHEMA.names})
        words = [pa.field(name, pa.string()) for name in others]
        groups.append(pa.Table.from_pylist(group, pa.schema([*SCHEMA, *words])))
    return pa.concat_tables(groups, promote_options="default"), keys


def rewrite(store: Store, found: Manifest) -> Manifest:
    """Write a manifest that was mended by hand anew, in both forms, and read it.

    Rows are put in order again, so that those written are numbered otherwise than
    those read. While a row is rejected the manifest is left as it is: that row is still
    to be mended.
    """
    if not found.mended or found.rejections:
        return found
    put(store, again(found))
    return read(store)


def again(found: Manifest) -> tuple[bytes, bytes]:
    """Encode a manifest that was mended by hand anew."""
    rows = [typed(row) for row in found.rows]
    return encoded(rows, title=found.title, mended=True, kept=found.kept)


def mended_by_hand(store: Store) -> tuple[str, bytes] | None:
    """Read the manifest if people have written in it, now or before an earlier build.

    Returns the name of the file that holds their work, and its bytes.
    """
    csv, parquet = source.both(store)
    marks: dict[bytes, bytes] = {}
    if parquet is not None:
        with contextlib.suppress(pa.ArrowException, OSError):  # what it told is lost
            marks = pq.read_schema(io.BytesIO(parquet)).metadata or {}
    if csv is None:
        return (PARQUET, parquet) if parquet is not None and MENDED in marks else None
    same = parquet is not None and source.belongs(parquet, csv)
    return None if same and MENDED not in marks else (CSV, csv)


def keep_copy(store: Store, name: str, data: bytes) -> str:
    """Keep a manifest under the day and time of now, and tell that name."""
    stem, _, kind = name.rpartition(".")
    stem += time.strftime(".%Y-%m-%dT%H%M%SZ", time.gmtime())
    names = (f"{stem}{n}.{kind}" for n in ("", *(f".{n}" for n in range(2, 100))))
    copy = next(one for one in names if not store.exists(one))
    store.write_bytes(copy, data)
    return copy


def typed(row: Row) -> dict[str, Any]:
    """Write a row's cells as the schema's types, unknown columns as they are."""
    known = row_of(row.photo, row.front, root=row.root, credit=row.credit)
    if row.front is None:  # what is known of a front that has no name yet is kept
        words = [one.name for one in FRONT if one.type == pa.string()]
        known |= {name: text(row.cells, name) for name in words}
    return row.cells | known


def place(row: dict[str, Any]) -> tuple[Any, ...]:
    """Order rows as one would walk: by block, ring, round the ring, then by photo."""
    return (
        row["block"] is None,
        natural(row["block"]),
        row["ring"] or 0,
        row["rank"] or 0,
        row["front_id"] or "",
        row["photo"] or "",
    )


@lru_cache(maxsize=1 << 16)
def natural(text: str | None) -> tuple[int, str]:
    """Order numbers of up to nine digits by value, and all else after them."""
    if text and text.isdecimal() and len(text) <= DIGITS:
        return int(text), ""
    return 10**DIGITS, text or ""


def read(store: Store, *, whole: bool = True) -> Manifest:
    """Read the manifest: the CSV if it was mended by hand, else the Parquet file.

    It is held as a whole: a run reads it in parts (`asked`). Of rows that are not
    `whole` no more cells are held than tell of their photographs.

    Raises:
        Unusable: if there is none, or if what there is makes no sense.
    """
    there = source.found(store)
    warnings = noticed(there)
    cells = (one for batch in there.batches() for one in batch)
    results = list(checked(cells) if whole else slim(checked(cells)))
    rows = tuple(one for one in results if isinstance(one, Row))
    return Manifest(
        rows,
        tuple(one.why for one in results if isinstance(one, Refused)),
        (*warnings, *contradictions(rows)),
        there.sha256,
        mended=there.mended,
        title=there.title,
        kept=there.kept,
    )


def slim(results: Iterable[Row | Refused]) -> Iterator[Row | Refused]:
    """Let go of cells that a row holds already, and hold words of many rows once."""
    words: dict[str, str] = {}
    for one in results:
        if isinstance(one, Refused):
            yield one
            continue
        cells = {name: one.cells[name] for name in told.TELLING if one.cells.get(name)}
        root, credit = (words.setdefault(each, each) for each in (one.root, one.credit))
        yield Row(one.number, root, one.photo, one.front, credit, cells)


def noticed(there: Source) -> list[str]:
    """Name columns that are not known; those that must be there are insisted on.

    Raises:
        Unusable: if one lacks, or nothing is written.
    """
    name, names = there.name, there.names()
    if not any(str(one).strip() for one in names):
        where = f"{there.where}/{name}"
        raise Unusable(f"{where} is empty: delete it, or run `nostalgin index --force`")
    missing = [one for one in REQUIRED if one not in names]
    if missing:
        raise Unusable(
            f"{name} lacks the columns {', '.join(missing)}: it has "
            f"{', '.join(map(str, names[:8]))}; docs/manifest.md describes them"
        )
    known = (*SCHEMA.names, *TOLD, *there.kept)
    unknown = [one for one in names if one not in known]
    return [f"{name}: column {one!r} is not known; it is kept" for one in unknown]


def checked(cells: Iterable[comma.Cells]) -> Iterator[Row | Refused]:
    """Check every row by itself, so that one bad row spoils no other.

    Rows in which nothing is written are counted, and else ignored.
    """
    for number, row in enumerate(cells, FIRST_ROW):
        if not comma.blank(row):
            yield usable(number, row)
