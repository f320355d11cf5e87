"""The two sides of the anti-join, as numbers: eight bytes of each name, and no row.

A side is a table of rows, each a photograph that may show a front of a block. What is
remembered of a row are hashes of its photograph and block; of a block, one hash over
its rows in their order.
"""

from array import array
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final, NamedTuple

import numpy as np
import pyarrow as pa

from nostalgin_core.records import Front
from pipelines import build
from pipelines.build import Streets
from pipelines.index.asked import COLUMNS, WHY, short
from pipelines.index.plan import BlockTask
from pipelines.index.roots import rooted
from pipelines.store.tables import from_row

CUT: Final = "cut_m"  # which streets' widths blocks use, by block
OF_PHOTOS: Final = ("targets_px", "outlines", "quads")
TOLD: Final = [name for name in COLUMNS.names if name not in {"number", *WHY.names}]


Widths = Mapping[str, float]  # in metres, of streets by their plain names


class Side(NamedTuple):
    """Rows that were asked for, or are; of a row without a photograph, zeros."""

    ids: np.ndarray  # uint64: of each row, where its photograph lies and its name
    names: np.ndarray  # uint64: its name alone, as rejections and facades have it
    blocks: np.ndarray  # uint64
    digests: Mapping[int, int]  # of each block: all that is told of it
    refused: int  # rows that can't be used
    cut: Mapping[str, Widths]  # of blocks that told streets cut in two


def side(
    tables: Iterable[pa.Table], city: str, directed: Mapping[str, Mapping[str, Any]]
) -> Side:
    """Read rows group by group."""
    ids, names, blocks = array("Q"), array("Q"), array("Q")
    digests: dict[int, int] = {}
    heights_m = directed.get("heights_m", {})
    of_photos = [directed.get(name, {}) for name in OF_PHOTOS]
    refused = 0
    cut = Cut(directed)
    for table in tables:
        usable = table.filter(table.column("reason").is_null())
        refused += table.num_rows - usable.num_rows
        cells = [usable.column(name).to_pylist() for name in TOLD]
        of = dict(zip(TOLD, cells, strict=True))
        where = zip(of["root"], of["photo"], of["block"], of["lot"], strict=True)
        for (root, photo, block, lot), row in zip(
            where, zip(*cells, strict=True), strict=True
        ):
            ids.append(short(rooted(root, city), photo) if photo else 0)
            names.append(short(photo) if photo else 0)
            blocks.append(short(block))
            more = [heights_m.get(f"{block}-{lot}")]
            more += [one.get(photo) for one in of_photos]
            cut.add(block, row)
            before = digests.get(blocks[-1], 0)
            digests[blocks[-1]] = short(str(before), repr(row), repr(more))
    for name, widths_m in cut.ended().items():
        told = repr(sorted(widths_m.items()))
        digests[short(name)] = short(str(digests[short(name)]), told)
    i, n, b = (np.frombuffer(one, np.uint64) for one in (ids, names, blocks))
    return Side(i, n, b, digests, refused, cut.found)


class Cut:
    """Finds which widths of streets blocks of two rings use, their rows following on.

    Where they are written by block they are read: of a run whose blocks were told at
    two times.
    """

    def __init__(self, directed: Mapping[str, Mapping[str, Any]]) -> None:
        """Take what a run was told of."""
        self.found: dict[str, Widths] = {}
        self._written: Mapping[str, Widths] = directed.get(CUT, {})
        known = (directed.get("widths_m", {}), directed.get("gaps_m", {}))
        self._streets = Streets(*known) if any(known) else None
        self._block = ""
        self._rows: list[Sequence[Any]] = []

    def add(self, block: str, row: Sequence[Any]) -> None:
        """Take a row, its cells in the order of `TOLD`."""
        if block in self._written:
            self.found[block] = self._written[block]
        if self._streets is None:
            return
        if block != self._block:
            self.ended()
        self._block = block
        self._rows.append(row)

    def ended(self) -> dict[str, Widths]:
        """End a block, and give all that were found."""
        rows = [dict(zip(TOLD, row, strict=True)) for row in self._rows]
        self._rows = []
        if self._streets is None or len({row["ring"] for row in rows}) != 2:
            return self.found
        fronts = {row["front_id"]: from_row(Front, row) for row in reversed(rows)}
        task = self._streets.told(BlockTask(self._block, (*fronts.values(),), (), ""))
        if task.widths_m:
            self.found[self._block] = dict(task.widths_m)
        return self.found


def differing(before: Mapping[int, int], after: Mapping[int, int]) -> np.ndarray:
    """List the blocks of which one side tells what the other does not."""
    found = [one for one, told in after.items() if before.get(one) != told]
    found += [one for one in before if one not in after]
    return np.array(sorted(found), np.uint64)


class Groups(NamedTuple):
    """Blocks that share photographs, and their photographs: what is redone together."""

    nodes: np.ndarray  # uint64, sorted: photographs' names and blocks
    labels: np.ndarray  # of each node: which group it is in

    def of(self, nodes: np.ndarray) -> np.ndarray:
        """Tell the groups of names and blocks that are known."""
        at = np.searchsorted(self.nodes, nodes)
        return self.labels[at]

    def first(self, labels: np.ndarray) -> np.ndarray:
        """Give the least name or block of each group."""
        known, at = np.unique(self.labels, return_index=True)  # nodes are sorted
        return self.nodes[at[np.searchsorted(known, labels)]]

    def within(self, labels: np.ndarray) -> np.ndarray:
        """List the names and blocks of some groups."""
        return self.nodes[np.isin(self.labels, labels)]


def groups(*sides: Side) -> Groups:
    """Group blocks by the photographs that they share, on either side."""
    names = np.concatenate([one.names for one in sides])
    blocks = np.concatenate([one.blocks for one in sides])
    return Groups(*build.together(names, blocks))
