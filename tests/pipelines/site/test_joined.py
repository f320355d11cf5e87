"""What is joined on the disk is what a join in memory gives, in however many parts."""

import json
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pipelines.index import asked
from pipelines.index.row import Row
from pipelines.site import joined as joining
from pipelines.site.aside import Aside
from pipelines.site.said import said
from pipelines.store import Store, runs
from pipelines.store.tables import to_row
from tests.pipelines.site import tables

BLOCKS, LOTS = 12, 9


def slowly(store: Store) -> dict[str, dict[str, Any]]:
    """Join all in memory."""
    photos = runs.read_table(store, tables.RUN, "photos")
    keys = {(one["root"], one["name"]): one["key"] for one in photos}
    why = defaultdict(list)
    for one in runs.read_table(store, tables.RUN, "rejections"):
        why[one["key"]].append(one)
    rows = defaultdict(list)
    for row in asked.rows(store, tables.RUN):
        assert isinstance(row, Row)
        assert row.front is not None
        rows[row.front.block].append(
            {
                "key": keys.get((f"{store.root}/{row.root}", row.photo)),
                "photo": row.photo,
                "credit": row.credit,
                "said": row.told,
                "year": row.cells["year"],
                "front": to_row(row.front),
                "rejections": why[row.photo] if row.photo else [],
            }
        )
    blocks = runs.read_table(store, tables.RUN, "blocks")
    records = {one["block"]: json.loads(one["record"]) for one in blocks}
    return {block: said(told, rows[block]) for block, told in records.items()}


@pytest.mark.parametrize("parts", [1, 2, 8])
def test_blocks_joined_on_the_disk_are_those_joined_in_memory(
    tmp_path: Path, parts: int
) -> None:
    store = Store(str(tmp_path))
    tables.write(store, BLOCKS, LOTS, parts)
    wanted = slowly(store)
    with Aside(tmp_path) as aside:
        found = joining.joined(store, tables.RUN, aside)
        assert [one.row["block"] for one in found] == sorted(wanted, key=int)
        assert {one.row["block"]: one.record() for one in found} == wanted
        for one in found:
            assert one.footprints_m.shape == (LOTS, 4, 2)
            assert np.all(one.heights_m == 15.0)
            assert len(one.plot.borders) == 4
    told = [one for block in wanted.values() for one in block["buildings"]]
    assert any(one["rejections"] for one in told)
    assert any(not photo["used"] for one in told for photo in one["photos"])
    assert {one["year"] for one in told} == {str(1900 + lot) for lot in range(LOTS)}


def test_a_photo_that_two_blocks_name_is_credited_in_each_as_its_rows_say(
    tmp_path: Path,
) -> None:
    store = Store(str(tmp_path))
    tables.write(store, 2, 4)
    own = [
        Row(one.number, one.root, "shared.jpg", one.front, f"by {n}", one.cells)
        for n, one in enumerate(tables.manifest_rows(2, 4))
    ]
    asked.written(store, tables.RUN, asked.told_as(own))
    sha256 = tables.sha256_of("shared.jpg")
    photo = {"name": "shared.jpg", "root": f"{store.root}/photos", "blocks": []}
    photo |= {"key": sha256[:16], "sha256": sha256}
    runs.write_table(store, tables.RUN, "photos", [photo])
    with Aside(tmp_path) as aside:
        found = joining.joined(store, tables.RUN, aside)
        named = [
            {p["credit"] for one in block.record()["buildings"] for p in one["photos"]
             if p["key"] == photo["key"]}
            for block in found
        ]  # fmt: skip
    assert named == [{f"by {n}" for n in range(4)}, {f"by {n}" for n in range(4, 8)}]
