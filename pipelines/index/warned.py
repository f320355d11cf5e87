"""What `index` warned of is kept, for those who were not there when it was told.

CITY/warnings.parquet      a row for each thing that was rejected, and each warning
"""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import pyarrow as pa
import pyarrow.parquet as pq

from nostalgin_core.records import Rejection
from pipelines import bounded
from pipelines.store import Store, tables

TABLE: Final = "warnings.parquet"
COLUMNS: Final = ("key", "reason", "detail")  # a warning is a detail alone
SCHEMA: Final = pa.schema([pa.field(name, pa.string()) for name in COLUMNS])


@dataclass(frozen=True)
class Warned:
    """What could not be taken as it is told, and what is doubtful."""

    rejections: tuple[dict[str, str], ...] = ()
    warnings: tuple[str, ...] = ()


def write(
    store: Store, rejections: Sequence[Rejection], warnings: Sequence[str]
) -> None:
    """Keep what was told, in its order."""
    rows = [{name: getattr(one, name) for name in COLUMNS} for one in rejections]
    rows += [{"key": "", "reason": "", "detail": one} for one in warnings]
    store.write_bytes(TABLE, tables.parquet_bytes(pa.Table.from_pylist(rows, SCHEMA)))


def read(store: Store) -> Warned:
    """Read what was told; nothing where there is no such table."""
    try:
        data = store.read_bytes(TABLE, bounded.TABLE_BYTES)
        rows = pq.read_table(io.BytesIO(data), columns=list(COLUMNS)).to_pylist()
    except (OSError, ValueError, pa.ArrowException):
        return Warned()
    told = [{name: str(row[name] or "") for name in COLUMNS} for row in rows]
    return Warned(
        tuple(one for one in told if one["reason"]),
        tuple(one["detail"] for one in told if not one["reason"]),
    )
