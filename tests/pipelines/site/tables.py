"""The tables of a run that nobody made: what publishing joins, for tests and measures.

Photographs show one lot each; of every seventh nothing came, every ninth could not be
read, every eleventh row has none. Block 3 of 5 has no model.
"""

import hashlib
import json
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pyarrow as pa

from nostalgin_core.records import Front
from pipelines.index import asked
from pipelines.index.row import Row
from pipelines.store import Store, runs

RUN = "run"
GLB = b"glTF of no building"
SHA256 = hashlib.sha256(GLB).hexdigest()
MODEL = "artifacts/block/0/00/" + "0" * 40 + ".parquet"
SIDE_M = (100.0, 60.0)
FRONT = Front("1-1-0", "1", "1", 0, 0, 0, "Elm Street", "1", 8.0, None, False)  # noqa: FBT003
STREETS = ("Elm Street", "First Avenue", "Oak Street", "Second Avenue")


def manifest_rows(blocks: int, lots: int) -> Iterator[Row]:
    """Give a row a lot; a photo is named twice where a lot has two rows."""
    number = 1
    for block in range(blocks):
        for lot in range(lots):
            number += 1
            side, rank = 4 * lot // lots, lot
            own = {"front_id": f"{block}-{lot}-{side}", "block": str(block)}
            own |= {"lot": str(lot), "side": side, "rank": rank}
            own |= {"street": f"{STREETS[side]} {block}", "address": f"{lot * 2 + 1}"}
            photo = "" if number % 11 == 0 else f"{block}/{lot}.jpg"
            cells = {"year": str(1900 + lot), "date": "about 1940"}
            credit = f"Archive {block % 3}"
            yield Row(number, "photos", photo, replace(FRONT, **own), credit, cells)


def sha256_of(name: str) -> str:
    """Hash a photo's name in place of its bytes."""
    return hashlib.sha256(name.encode()).hexdigest()


def record(block: str, rows: list[Row]) -> dict[str, Any]:
    """Write what a block's stage knows of it."""
    east, north = SIDE_M
    buildings = []
    for row in rows:
        key = sha256_of(row.photo)[:16]
        used = bool(row.photo) and row.number % 7 != 0
        camera = {"front": row.front and row.front.front_id, "position_m": [0.0] * 3}
        camera |= {
            "block_from_camera": [[0.123456] * 3] * 3,
            "quad_px": [[1.5, 2.5]] * 4,
        }
        photo = {"key": key, "used": True, "caption": row.photo, "camera": camera}
        lot = row.front.lot if row.front else ""
        buildings.append(
            {
                "id": f"{block}-{lot}",
                "lot": lot,
                "address": f"{lot} Elm Street",
                "street": "Elm Street",
                "fronts": [row.front.front_id if row.front else ""],
                "photos": [photo] if used else [],
                "width_m": 8.0,
                "height_m": 15.0,
                "footprint_m": [[0.0, 0.0], [8.0, 0.0], [8.0, 9.0], [0.0, 9.0]],
                "assumed": not used,
                "photographed_share": 0.8 if used else 0.0,
                "rejections": [],
            }
        )
    outline = [[[0.0, 0.0], [east, 0.0], [east, north], [0.0, north]]]
    return {"block": block, "outline_m": outline, "buildings": buildings}


def write(store: Store, blocks: int, lots: int = 24, parts: int = 0) -> None:
    """Write the tables of a run over so many blocks, in parts as a build does."""
    count = parts or runs.parts_of(blocks * lots)
    asked.written(store, RUN, asked.told_as(manifest_rows(blocks, lots)))
    tables: dict[str, list[list[dict[str, Any]]]] = {
        name: [[] for _ in range(count)]
        for name in ("photos", "rejections", "blocks", "buildings")
    }

    def put(name: str, row: dict[str, Any]) -> None:
        tables[name][runs.part_of(name, row, count)].append(row)

    for block, rows in by_block(blocks, lots):
        for row in rows:
            rows_of(row, f"{store.root}/photos", put)
        if block % 5 != 3:
            modelled(str(block), rows, put)
    for name, own in tables.items():
        for part, some in enumerate(own):
            runs.write_table(store, RUN, name, some, (part, count))
    store.write_table(MODEL, pa.table({"glb": pa.array([GLB], pa.large_binary())}))


def by_block(blocks: int, lots: int) -> Iterator[tuple[int, list[Row]]]:
    """Give each block's rows."""
    every = manifest_rows(blocks, lots)
    return ((block, [next(every) for _ in range(lots)]) for block in range(blocks))


def rows_of(row: Row, root: str, put: Any) -> None:
    """Tell of a row's photo: that it was read, or why nothing came of it."""
    if not row.photo:
        return
    if row.number % 9 == 0:
        why = {"stage": "photo", "reason": "no picture", "detail": "mend it"}
        put("rejections", {"key": row.photo, **why})
        return
    sha256 = sha256_of(row.photo)
    told = {"name": row.photo, "root": root, "key": sha256[:16], "sha256": sha256}
    put("photos", told | {"blocks": [row.front.block if row.front else ""]})
    if row.number % 7 == 0:
        why = {"stage": "rectify", "reason": "leans", "detail": None}
        put("rejections", {"key": row.photo, **why})


def modelled(block: str, rows: list[Row], put: Any) -> None:
    """Tell of a block that has a model."""
    east, north = SIDE_M
    told = record(block, rows)
    put(
        "blocks",
        {
            "block": block,
            "model": MODEL,
            "sha256": SHA256,
            "low_m": [0.0, 0.0, 0.0],
            "high_m": [east, north, 15.0],
            "coarse_sha256": "",
            "coarse_texel_m": 0.0,
            "buildings": len(rows),
            "record": json.dumps(told, sort_keys=True),
        },
    )
    for one in told["buildings"]:
        ground = [value for point in one["footprint_m"] for value in point]
        own = {"building_id": one["id"], "height_m": 15.0, "footprint_m": ground}
        put("buildings", {"block": block, **own})
