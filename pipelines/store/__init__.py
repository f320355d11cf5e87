"""A city folder: files that are there wholly or not at all, under keys of their making.

In: bytes, tables, records, rejections. Out: the same, on any machine.
`Versions` names what is kept by the code and parameters that made it; `runs` and
`tables` say what a run's tables and a record's columns are. Open `store` first.
"""

from pipelines.store.store import Store, Unstored, parquet_bytes, textual
from pipelines.store.versions import Versions

__all__ = ["Store", "Unstored", "Versions", "parquet_bytes", "textual"]
