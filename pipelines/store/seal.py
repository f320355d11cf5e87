"""Parquet whose damage shows: nothing is read that is not what was written.

Every page of data carries the format's own CRC-32, and the footer, which tells where
the pages lie, a SHA-256 of itself (with zeros in the place of the sum), of the file's
size and of its name in the store. So a column is read, and vouched for, without reading
the others, and no file passes for another.
"""

import hashlib
import io
from collections.abc import Iterable, Sequence
from typing import Final

import pyarrow as pa
import pyarrow.parquet as pq

SEAL: Final = b"nostalgin.seal"
ZEROS: Final = b"0" * 64  # of a sum in hexadecimal digits
LENGTH: Final = b"\x18\x40"  # in Thrift: a text of 64 bytes follows
MAGIC: Final = b"PAR1"
TAIL: Final = 8  # bytes: the footer's length, and the magic


class Damaged(ValueError):  # noqa: N818 - it reads as what it is about
    """A file that is not what was written: bytes fell out or were changed."""

    def __init__(self, why: str, name: str = "") -> None:
        """Tell what is wrong, and with which file of a store, if that is known."""
        super().__init__(why, name)
        self.why, self.name = why, name

    def __str__(self) -> str:
        """Tell both."""
        return f"{self.name} is damaged: {self.why}"


def sealed(table: pa.Table, name: str = "") -> bytes:
    """Encode a table; the same rows and name give the same bytes."""
    return sealed_groups(table.schema, [table], name)


def sealed_groups(schema: pa.Schema, groups: Iterable[pa.Table], name: str) -> bytes:
    """Encode tables as the row groups of one file, holding one at a time."""
    marked = schema.with_metadata({**(schema.metadata or {}), SEAL: ZEROS})
    sink = io.BytesIO()
    with pq.ParquetWriter(
        sink,
        marked,
        compression="zstd",
        use_dictionary=False,
        write_statistics=False,
        write_page_checksum=True,
    ) as writer:
        for table in groups:
            writer.write_table(table.replace_schema_metadata(marked.metadata))
    return signed(sink.getvalue(), name)


def signed(data: bytes, name: str) -> bytes:
    """Put its sum into the footer of a file that was written with zeros there."""
    footer = data[-TAIL - length(data[-TAIL:]) :]
    at = len(data) - len(footer) + place(footer)
    return data[:at] + digest(footer, len(data), name) + data[at + len(ZEROS) :]


def opened(file: pa.NativeFile, name: str = "") -> pq.ParquetFile:
    """Open a file whose footer is what was written; its pages are checked as read.

    Raises:
        Damaged: if the footer is another's, or cut off.
        OSError: if it can't be read at all.
    """
    size = file.size()
    if size < TAIL:
        raise Damaged(f"{size} bytes")
    tail = file.read_at(TAIL, size - TAIL)
    whole = length(tail) + TAIL
    if whole > size:
        raise Damaged(f"a footer of {whole} bytes in {size}")
    footer = file.read_at(whole, size - whole)
    at = place(footer)
    blank = footer[:at] + ZEROS + footer[at + len(ZEROS) :]
    if digest(blank, size, name) != footer[at : at + len(ZEROS)]:
        raise Damaged("the footer is not what was written")
    return pq.ParquetFile(file, page_checksum_verification=True)


def read(
    artifact: pq.ParquetFile,
    columns: Sequence[str] | None = None,
    groups: Iterable[int] | None = None,
) -> pa.Table:
    """Read a table, or some of its columns, or of its row groups.

    Raises:
        Damaged: if a page is not what was written.
        OSError: if it can't be read at all.
    """
    wanted = None if columns is None else list(columns)
    try:
        if groups is None:
            return artifact.read(wanted)
        return artifact.read_row_groups(list(groups), wanted)
    except (OSError, pa.ArrowException) as problem:
        if isinstance(problem, OSError) and problem.errno is not None:
            raise  # the disk's word, or the network's
        raise Damaged(str(problem).strip()) from problem


def length(tail: bytes) -> int:
    """Read a footer's length from a file's last eight bytes.

    Raises:
        Damaged: if it is no Parquet.
    """
    if tail[4:] != MAGIC:
        raise Damaged("no Parquet")
    return int.from_bytes(tail[:4], "little")


def place(footer: bytes) -> int:
    """Find where in a footer its sum stands.

    Raises:
        Damaged: if there is none.
    """
    before = SEAL + LENGTH
    at = footer.rfind(before) + len(before)
    if at < len(before) or at + len(ZEROS) > len(footer):
        raise Damaged("no seal")
    return at


def digest(footer: bytes, size: int, name: str) -> bytes:
    """Sum up a footer whose own sum is zeros, with what it is the footer of."""
    whole = footer + f"\0{size}\0{name}".encode()
    return hashlib.sha256(whole).hexdigest().encode()
