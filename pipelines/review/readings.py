"""What was read on photographs' boards, as `index` left it, if it did."""

import base64
import io
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import pyarrow as pa
import pyarrow.parquet as pq

from nostalgin_core.catalogue import inside
from pipelines import bounded
from pipelines.index.readings import TABLE
from pipelines.store import Store

AGREED: Final = "agreed"  # all three witnesses: nothing is to be decided
CROP_BYTES: Final = 1_000_000
PNG: Final = b"\x89PNG\r\n\x1a\n"


@dataclass(frozen=True)
class Reading:
    """What a photograph's name, its board and the list say, and what was made of it."""

    verdict: str
    name_says: str
    board_says: str
    list_says: str
    keys: tuple[str, ...]  # block-lot that somebody says, the likeliest first
    runner_up: str
    score: float | None  # of the likeliest key, 0 to 1
    remedy: str
    crop: str  # the name of its board's picture; empty: there is none

    @property
    def open(self) -> bool:
        """Tell whether somebody is to look at it."""
        return self.verdict != AGREED


def readings(store: Store) -> dict[str, Reading]:
    """Read what was read, by photograph; nothing where there is no such table."""
    try:
        data = store.read_bytes(TABLE, bounded.TABLE_BYTES)
        table = pq.read_table(io.BytesIO(data)) if data else pa.table({})
    except (OSError, pa.ArrowException):
        return {}
    rows = table.to_pylist()
    return {word(row, "photo"): reading(row) for row in rows}


def reading(row: Mapping[str, Any]) -> Reading:
    """Read one row; what it lacks is empty."""
    put = pair(word(row, "joined_block"), word(row, "joined_lot"))
    read = pair(word(row, "read_block"), word(row, "read_lot"))
    listed = word(row, "list_says").split("; ")
    others = (word(row, "name_says"), word(row, "runner_up"))
    score = row.get("score")
    return Reading(
        verdict=word(row, "verdict"),
        name_says=word(row, "name_says"),
        board_says=word(row, "board_says"),
        list_says=word(row, "list_says"),
        keys=tuple(dict.fromkeys(filter(None, (put, read, *listed, *others)))),
        runner_up=word(row, "runner_up"),
        score=float(score) if isinstance(score, (int, float)) else None,
        remedy=word(row, "remedy"),
        crop=word(row, "crop"),
    )


def pair(block: str, lot: str) -> str:
    """Write a key in one cell."""
    return f"{block}-{lot}" if block and lot else ""


def crop(name: str, store: Store) -> str:
    """Give a board's picture as a data URI; empty: it is none of the city's."""
    if not name or not inside(name):
        return ""
    try:
        data = store.read_bytes(name, CROP_BYTES)
    except (OSError, ValueError):
        return ""
    coded = base64.b64encode(data).decode()
    return f"data:image/png;base64,{coded}" if data.startswith(PNG) else ""


def word(row: Mapping[str, Any], name: str) -> str:
    """Read a cell of words."""
    cell = row.get(name)
    return "" if cell is None else str(cell)
