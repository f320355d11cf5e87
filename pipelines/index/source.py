"""A manifest as it lies in its folder, read a thousand rows at a time.

It is the CSV if that was mended by hand, else the Parquet file, which remembers the
hash of the CSV that it was written with. Two files can't be replaced at once, so the
Parquet file is written under a name of its own first: of a process that was killed
between the two the CSV on the disk still has the Parquet file that it belongs to.
"""

import contextlib
import hashlib
import io
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import pyarrow as pa
import pyarrow.parquet as pq

from pipelines import bounded
from pipelines.index import comma
from pipelines.index.row import CSV
from pipelines.store import Store

PARQUET: Final = "manifest.parquet"
COMING: Final = "manifest.parquet.coming"  # while the manifest is being written
CSV_HASH: Final = b"nostalgin.csv_sha256"
TITLE: Final = b"nostalgin.title"
KEPT: Final = b"nostalgin.kept"  # columns of a list that mean nothing here
BATCH: Final = 1000  # rows


class Unusable(ValueError):  # noqa: N818 - it reads as what it is about
    """A manifest that can't be read at all, with what to do about it."""


@dataclass(frozen=True)
class Source:
    """A manifest whose rows are yet to be read."""

    where: str  # the city folder
    name: str  # of the file that counts
    data: bytes
    title: str = ""
    mended: bool = False  # the CSV was edited since it was written
    kept: tuple[str, ...] = ()  # columns that `index` took from a list

    @property
    def sha256(self) -> str:
        """Hash what is read."""
        return hashlib.sha256(self.data).hexdigest()

    def names(self) -> list[str]:
        """Name the columns.

        Raises:
            Unusable: if it is no table.
        """
        if self.name == PARQUET:
            return opened(self.data, self.where).schema_arrow.names
        return parsed_csv(self.data, f"{self.where}/{CSV}")[0]

    def batches(self) -> Iterator[Sequence[comma.Cells]]:
        """Read the rows' cells.

        Raises:
            Unusable: if they can't be read to their end.
        """
        if self.name == PARQUET:
            yield from parsed(self.data, self.where)
        else:
            yield parsed_csv(self.data, f"{self.where}/{CSV}")[1]


def found(store: Store) -> Source:
    """Find the manifest of a city folder: what people wrote in it counts.

    Raises:
        Unusable: if there is none, or if what there is makes no sense.
    """
    csv, parquet = both(store)
    title, kept = "", tuple[str, ...]()
    if parquet is not None:
        there = of_parquet(parquet, store.root)
        if csv is None or belongs(parquet, csv):
            return there
        title, kept = there.title, there.kept
    if csv is None:
        raise Unusable(f"{store.root} has no {PARQUET}: run `nostalgin index` first")
    mended = parquet is not None
    return Source(store.root, CSV, csv, title, mended=mended, kept=kept)


def both(store: Store) -> tuple[bytes | None, bytes | None]:
    """Read the manifest's two forms, the CSV and the Parquet file that goes with it.

    Raises:
        Unusable: if one of them is there and can't be read.
    """
    csv, parquet = optional(store, CSV), optional(store, PARQUET)
    if csv is None or (parquet is not None and belongs(parquet, csv)):
        return csv, parquet
    coming = optional(store, COMING)
    return csv, coming if coming is not None and belongs(coming, csv) else parquet


def belongs(parquet: bytes, csv: bytes) -> bool:
    """Tell whether a Parquet file was written with this CSV; a spoiled one was not."""
    try:
        told = pq.read_schema(io.BytesIO(parquet)).metadata or {}
    except (pa.ArrowException, OSError):
        return False
    return told.get(CSV_HASH) == hashlib.sha256(csv).hexdigest().encode()


def of_parquet(data: bytes, where: str) -> Source:
    """Take the Parquet form of a manifest, written or yet to be.

    Raises:
        Unusable: if it makes no sense.
    """
    told, kept = marks(data, where), tuple[str, ...]()
    title = told.get(TITLE, b"").decode(errors="replace")
    with contextlib.suppress(ValueError, TypeError):  # they are warned of, then
        kept = tuple(map(str, json.loads(told.get(KEPT, b"[]"))))
    return Source(where, PARQUET, data, title, kept=kept)


def marks(data: bytes, where: str) -> dict[bytes, bytes]:
    """Read what the Parquet form tells beside its rows.

    Raises:
        Unusable: if it is none.
    """
    return opened(data, where).schema_arrow.metadata or {}


def optional(store: Store, name: str) -> bytes | None:
    """Read a file if it is there.

    Raises:
        Unusable: if it can't be read.
    """
    if not store.exists(name):
        return None
    try:
        return store.read_bytes(name, bounded.TABLE_BYTES)
    except OSError as problem:
        why = problem.strerror or str(problem)
        raise Unusable(
            f"{store.root}/{name}: {why}; mend the file or move it away"
        ) from problem


def opened(data: bytes, where: str) -> pq.ParquetFile:
    """Open the Parquet form, unless it claims to be more than is read.

    Raises:
        Unusable: if it does, or is none.
    """
    try:
        file = pq.ParquetFile(io.BytesIO(data))
        told = file.metadata
        groups = [told.row_group(number) for number in range(told.num_row_groups)]
        size = sum(one.total_byte_size for one in groups)
        bounded.fits(size, bounded.TABLE_BYTES, "")
        names = file.schema_arrow.names
        if len(set(names)) < len(names):
            raise pa.ArrowInvalid("two columns have one name")
        if told.num_rows > comma.MOST_ROWS:  # a run of equal ones takes no bytes
            raise pa.ArrowInvalid(f"more than {comma.MOST_ROWS:,} rows")
    except (pa.ArrowException, OSError) as problem:
        raise no_parquet(where, problem) from problem
    return file


def parsed(data: bytes, where: str) -> Iterator[list[comma.Cells]]:
    """Read the Parquet form bit by bit: a long word that is repeated takes no bytes.

    Raises:
        Unusable: if it has more bytes than are read, or words that are no UTF-8.
    """
    file, size = opened(data, where), 0
    try:
        for batch in file.iter_batches(BATCH):
            plain = [
                one.dictionary_decode() if pa.types.is_dictionary(one.type) else one
                for one in batch.columns
            ]
            size += sum(one.nbytes for one in plain)
            bounded.fits(size, bounded.TABLE_BYTES, "")
            table = pa.Table.from_arrays(plain, file.schema_arrow.names)
            table.validate(full=True)
            yield table.to_pylist()
    except (pa.ArrowException, OSError) as problem:
        raise no_parquet(where, problem) from problem


def no_parquet(where: str, problem: Exception) -> Unusable:
    """Tell what is wrong with the Parquet form, and what to do."""
    return Unusable(
        f"{where}/{PARQUET} is no Parquet file ({problem}): delete it, and "
        f"{CSV} will be read, or run `nostalgin index --force`"
    )


def parsed_csv(data: bytes, where: str) -> tuple[list[str], Sequence[comma.Cells]]:
    """Parse the form that people mend."""
    try:
        return comma.parsed(data, ours=True)
    except comma.NoTable as problem:
        raise Unusable(f"{where} {problem}") from problem
