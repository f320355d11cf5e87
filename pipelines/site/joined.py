"""What a run's tables tell of each block, brought together, block after block.

    the manifest's rows, photos, rejections --by the photo's name--> rows that know both
    rows, blocks, buildings                 --by the block--------> `Joined`

Either step sets its rows down on the disk in heaps, and holds one heap. What a block
has to be placed and drawn by is given as it is, its record as a way to read it.
"""

import json
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from nostalgin_core import city
from nostalgin_core.records import Front
from pipelines.index import asked
from pipelines.index.manifest import natural
from pipelines.index.roots import rooted
from pipelines.index.row import Row
from pipelines.site.aside import Aside, Heaps
from pipelines.site.placing import plot_of
from pipelines.site.said import said
from pipelines.store import Store, runs, tables

MOST: Final = 128  # heaps, each of which is an open file
EACH: Final = 4  # heaps for a part of the run's tables: some 5,000 rows in one

Json = dict[str, Any]


@dataclass(frozen=True, slots=True, eq=False)
class Joined:
    """One block: its row of the table, its ground, and how to read its record."""

    row: Json
    plot: city.Plot
    record: Callable[[], Json]
    footprints_m: np.ndarray  # n 4 2
    heights_m: np.ndarray


def joined(store: Store, run: str, aside: Aside) -> list[Joined]:
    """Bring together what is told of each block, in the order of their numbers.

    Raises:
        Damaged: if a table is.
    """
    folder = Path(store.root)
    parts = len(runs.part_names(store, run, "photos"))
    count = min(MOST, EACH * max(1, parts))
    with Heaps(folder, count) as blocks:
        with Heaps(folder, count) as photos:
            for kind, name, row in of_photos(store, run):
                photos.put(name, {"kind": kind, **row})
            for heap in photos.each():
                for row in known(heap):
                    blocks.put(row["block"], row)
        for name in ("blocks", "buildings"):
            for row in runs.read_rows(store, run, name):
                blocks.put(row["block"], {"kind": name, **kept(row)})
        found = [one for heap in blocks.each() for one in together(heap, aside)]
    return sorted(found, key=lambda one: natural(one.row["block"]))


def of_photos(store: Store, run: str) -> Iterator[tuple[str, str, Json]]:
    """Read what is told of photos, by their names: rows, keys, rejections."""
    there = (one for one in asked.rows(store, run) if isinstance(one, Row))
    for number, row in enumerate(there):
        if row.front is not None:
            told = {"number": number, "block": row.front.block, "photo": row.photo}
            told |= {"root": rooted(row.root, store.root), "credit": row.credit}
            year = str(row.cells.get("year") or "").strip()
            told |= {"said": row.told, "year": year, "front": tables.to_row(row.front)}
            yield "row", row.photo, told
    for row in runs.read_rows(store, run, "photos"):
        yield "photo", row["name"], {n: row[n] for n in ("root", "name", "key")}
    for row in runs.read_rows(store, run, "rejections"):
        yield "rejection", row["key"], row


def known(heap: Iterable[Json]) -> Iterator[Json]:
    """Give a heap's rows the keys of their photos, and why those went no further."""
    keys: dict[tuple[str, str], str] = {}
    why: dict[str, list[Json]] = defaultdict(list)
    rows = []
    for one in heap:
        kind = one.pop("kind")
        if kind == "row":
            rows.append(one)
        elif kind == "photo":
            keys[one["root"], one["name"]] = one["key"]
        else:
            why[one["key"]].append(one)
    for row in rows:
        key = keys.get((row["root"], row["photo"]))
        rejections = why.get(row["photo"], []) if row["photo"] else []
        yield {"kind": "row", **row, "key": key, "rejections": rejections}


def kept(row: Json) -> Json:
    """Give of a row of blocks or buildings what a site needs."""
    needless = ("outlines_m", "closures_m", "compared")
    if "record" in row:
        return {name: value for name, value in row.items() if name not in needless}
    return {name: row[name] for name in ("block", "footprint_m", "height_m")}


def together(heap: Iterable[Json], aside: Aside) -> Iterator[Joined]:
    """Bring together a heap's blocks; rows of one that has no model are left."""
    blocks, stand, rows = {}, defaultdict(list), defaultdict(list)
    for one in heap:
        kind, block = one.pop("kind"), one["block"]
        if kind == "blocks":
            blocks[block] = one
        else:
            (rows if kind == "row" else stand)[block].append(one)
    for block, told in blocks.items():
        own = sorted(rows[block], key=lambda one: one["number"])
        record = json.loads(told.pop("record"))
        fronts = [tables.from_row(Front, one["front"]) for one in own]
        plot = plot_of(record, fronts)
        data = aside.put(json.dumps(said(record, own)).encode())
        footprints = [one["footprint_m"] for one in stand[block]]
        heights = np.array([one["height_m"] for one in stand[block]])
        grounds = np.array(footprints).reshape(-1, 4, 2)
        yield Joined(told, plot, partial(read, data), grounds, heights)


def read(data: Callable[[], bytes]) -> Json:
    """Read a record that lies aside."""
    return json.loads(data())
