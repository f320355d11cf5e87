"""What `index` warned of is kept, for those who were not there when it was told.

CITY/warnings.parquet      a row for each thing that was rejected, and each doubt
"""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import pyarrow as pa
import pyarrow.parquet as pq

from nostalgin_core.catalogue import Doubt
from nostalgin_core.records import Rejection
from pipelines import bounded
from pipelines.store import Store, tables

TABLE: Final = "warnings.parquet"
REJECTED: Final = ("key", "reason", "detail")  # of a doubt the detail alone
WORDS: Final = ("block", "lot", "address", "photo")
TEXT = pa.string()
SCHEMA: Final = pa.schema(
    [
        *(pa.field(name, TEXT) for name in (*REJECTED, *WORDS)),
        pa.field("rows", pa.list_(pa.int64())),  # of the list
        pa.field("likely", pa.list_(TEXT)),  # addresses
        pa.field("named", pa.list_(TEXT)),  # block and lot
    ]
)


@dataclass(frozen=True)
class Warned:
    """What could not be taken as it is told, and what is doubtful."""

    rejections: tuple[dict[str, str], ...] = ()
    doubts: tuple[Doubt, ...] = ()


def write(
    store: Store, rejections: Sequence[Rejection], doubts: Sequence[Doubt]
) -> None:
    """Keep what was told, in its order."""
    rows: list[dict[str, Any]] = [
        {name: getattr(one, name) for name in REJECTED} for one in rejections
    ]
    for one in doubts:
        told = {name: getattr(one, name) for name in WORDS}
        lists = {"rows": one.rows, "likely": one.likely, "named": one.named}
        rows.append({"key": "", "reason": "", "detail": one.text} | told | lists)
    store.write_bytes(TABLE, tables.parquet_bytes(pa.Table.from_pylist(rows, SCHEMA)))


def read(store: Store) -> Warned:
    """Read what was told; nothing where there is no such table."""
    try:
        data = store.read_bytes(TABLE, bounded.TABLE_BYTES)
        rows = pq.read_table(io.BytesIO(data)).to_pylist()
        told = [{name: str(row[name] or "") for name in REJECTED} for row in rows]
        doubts = [doubt(row) for row in rows if not row["reason"]]
    except (OSError, ValueError, TypeError, KeyError, pa.ArrowException):
        return Warned()
    return Warned(tuple(one for one in told if one["reason"]), tuple(doubts))


def doubt(row: dict[str, Any]) -> Doubt:
    """Read one; of an earlier release words are all there is."""
    block, lot, address, photo = (str(row.get(name) or "") for name in WORDS)
    named = [*map(str, row.get("named") or ()), "", ""]
    return Doubt(
        str(row["detail"] or ""),
        block,
        lot,
        tuple(map(int, row.get("rows") or ())),
        address,
        tuple(map(str, row.get("likely") or ())),
        photo,
        (named[0], named[1]),
    )
