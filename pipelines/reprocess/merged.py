"""A run's tables, made of what was redone and of what the run before it tells.

Two parts are held at a time, and each part reads as many of the earlier tables as may
hold rows of it: the work is linear in rows, also where the count of parts is another.
A part in which nothing changed is written as it was read.
"""

from typing import Any, Final

import numpy as np
import pyarrow as pa

from pipelines.index.asked import short
from pipelines.store import Store, runs

# By which column it is known whether a row was redone.
SUBJECT: Final = {
    "photos": "name",
    "stamps": "name",
    "facades": "name",
    "buildings": "block",
    "blocks": "block",
    "claims": "block",
    "borrowed": "name",
    "rejections": "key",
}
OF_ROWS: Final = ("manifest", "corrections")  # stages whose rejections are told anew


def merge(store: Store, run: str, before: str, parts: int, redone: np.ndarray) -> None:
    """Write the tables of a run that redid some names and blocks of the one before."""
    for name in SUBJECT:
        there = count(store, before, name)
        for part in range(parts):
            which = (part, parts)
            same = parts == there
            old = (
                [one(store, before, name, which)]
                if same
                else whole(store, before, name, which)
            )
            kept = [stays(table, name, redone) for table in old]
            new = whole(store, f"{run}/{runs.REDONE}", name, which)
            write(store, (run, name, which), old, [*kept, *new])


def complete(store: Store, run: str) -> bool:
    """Tell whether a run has all the tables and columns that runs have now."""
    return all(whole_table(store, run, name) for name in SUBJECT)


def whole_table(store: Store, run: str, name: str) -> bool:
    """Tell whether all parts of a table are there, with the columns of now."""
    parts = count(store, run, name)
    wanted = [runs.table_path(run, name, (part, parts)) for part in range(parts)]
    names = runs.SCHEMAS[name].names
    return bool(parts) and all(
        store.exists(path) and store.read_table(path).column_names == names
        for path in wanted
    )


def count(store: Store, run: str, name: str) -> int:
    """Count the parts of a run's table."""
    return len(runs.part_names(store, run, name))


def one(store: Store, run: str, name: str, which: runs.Part) -> pa.Table:
    """Read one part of a table."""
    return store.read_table(runs.table_path(run, name, which))


def whole(store: Store, run: str, name: str, which: runs.Part) -> list[pa.Table]:
    """Read of a table that may have other parts the rows that fall into this one."""
    there = count(store, run, name)
    parts = ((each, there) for each in runs.sources(which, there))
    return [falling(one(store, run, name, each), name, which) for each in parts]


def falling(table: pa.Table, name: str, which: runs.Part) -> pa.Table:
    """Take the rows that fall into a part."""
    part, parts = which
    first = runs.SCHEMAS[name].names[0]
    told = table.column(first).to_pylist()
    mine = [runs.part_of(name, {first: cell}, parts) == part for cell in told]
    return table.filter(pa.array(mine, pa.bool_()))


def stays(table: pa.Table, name: str, redone: np.ndarray) -> pa.Table:
    """Leave out the rows that were redone."""
    told = table.column(SUBJECT[name]).to_pylist()
    gone = np.isin(np.array([short(cell) for cell in told], np.uint64), redone)
    if name == "rejections":
        stages = table.column("stage").to_pylist()
        gone |= np.array([stage in OF_ROWS for stage in stages], bool)
    return table.filter(pa.array(~gone))


def write(
    store: Store,
    place: tuple[str, str, runs.Part],
    old: list[pa.Table],
    new: list[pa.Table],
) -> None:
    """Write one part of a table: of a run, its name, and which part."""
    run, name, which = place
    rows = sum(table.num_rows for table in new)
    unchanged = len(old) == 1 and rows == old[0].num_rows == new[0].num_rows
    if unchanged:
        table = old[0].cast(runs.SCHEMAS[name]).replace_schema_metadata(None)
        store.write_table(runs.table_path(run, name, which), table)
        return
    told: list[dict[str, Any]] = [row for table in new for row in table.to_pylist()]
    runs.write_table(store, run, name, told, which)


def drop(store: Store, run: str) -> None:
    """Remove the tables of what was redone."""
    store.drop_tree(f"runs/{run}/{runs.REDONE}")
