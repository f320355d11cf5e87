"""In how many runs a photograph or a block crashed: at last it is left to people.

CITY/crashes.parquet      a row for each, as long as it crashes, and its versions

A crash is tried again, for memory or a disk may be there the next time. What crashed
in `MOST` runs one after the other is let be until its file, a row or a version
changes, or somebody asks for it by `--retry`.
"""

import io
import json
from collections.abc import Mapping
from typing import Final

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from pipelines import bounded
from pipelines.build import CRASHED, Report
from pipelines.index.asked import short
from pipelines.store import Store, key_of, tables
from pipelines.store.versions import Versions

TABLE: Final = "crashes.parquet"
MOST: Final = 3
SCHEMA: Final = pa.schema([pa.field("key", pa.string()), pa.field("runs", pa.int64())])
VERSIONS: Final = b"nostalgin.versions"


def tries(store: Store, versions: Versions) -> dict[str, int]:
    """Read in how many runs each crashed; nothing of other versions, or of nonsense."""
    try:
        data = store.read_bytes(TABLE, bounded.TABLE_BYTES)
        table = pq.read_table(io.BytesIO(data))
        if (table.schema.metadata or {}).get(VERSIONS) != named(versions):
            return {}
        keys, runs = (table.column(one).to_pylist() for one in SCHEMA.names)
    except (OSError, ValueError, KeyError, pa.ArrowException):
        return {}
    pairs = zip(keys, runs, strict=True)
    return {key: n for key, n in pairs if isinstance(key, str) and isinstance(n, int)}


def counted(
    before: Mapping[str, int],
    report: Report,
    *,
    redone: np.ndarray,
    crashed: np.ndarray,
    anew: np.ndarray,
) -> dict[str, int]:
    """Count the crashes of a run on top of those before.

    Names and blocks are eight bytes each, sorted: what the run has `redone`, what had
    `crashed` in the run before it, and the files that it met `anew`.
    """
    told = {key: n for key, n in before.items() if not among(key, redone)}
    for one in report.rejections:
        key = one["key"]
        if one["reason"] == CRASHED and among(key, redone):
            known = 0 if among(key, anew) else before.get(key, among(key, crashed))
            told[key] = int(known) + 1
    return told


def among(key: str, some: np.ndarray) -> bool:
    """Tell whether a name is one of some, sorted."""
    one = np.uint64(short(key))
    at = int(np.searchsorted(some, one))
    return at < len(some) and bool(some[at] == one)


def keep(store: Store, versions: Versions, told: Mapping[str, int]) -> None:
    """Write in how many runs each crashed; no file where none did."""
    if not told:
        store.remove(TABLE)
        return
    columns = [pa.array(sorted(told)), pa.array([told[key] for key in sorted(told)])]
    marked = SCHEMA.with_metadata({VERSIONS: named(versions)})
    table = pa.Table.from_arrays(columns, schema=marked)
    store.write_bytes(TABLE, tables.parquet_bytes(table))


def named(versions: Versions) -> bytes:
    """Name the versions of all stages in one."""
    return key_of(json.dumps(vars(versions), sort_keys=True)).encode()
