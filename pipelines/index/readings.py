"""What file names, list and boards say of each photograph's place, as one table.

    CITY/readings.parquet        a row a photograph, in the order of their names
    CITY/readings/<key>.png      the board of one that a person is to look at

The table tells; what it decides stands in the manifest. A cell that no witness filled
is empty. `docs/placards.md` describes the columns.
"""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import Final, Self

import pyarrow as pa

from nostalgin_core.placard import VERDICTS, Joined, Judged, Key, Verdict
from pipelines.store import Store, tables

TABLE: Final = "readings.parquet"
FOLDER: Final = "readings"  # of the pictures
GROUP: Final = 4096  # rows that are held as Python has them
TEXT, NUMBER = pa.string(), pa.float64()
COLUMNS: Final = (
    ("photo", TEXT),  # as in the manifest
    ("key", TEXT),  # the first 16 hex digits of its SHA-256, if it was looked at
    ("name_says", TEXT),  # block-lot
    ("board_says", TEXT),  # the most telling line, as it was read
    ("read_block", TEXT),  # what the board spells, on the list or not
    ("read_lot", TEXT),
    ("score", NUMBER),  # probability of the likeliest key, 0 to 1
    ("runner_up", TEXT),
    ("runner_up_score", NUMBER),
    ("list_says", TEXT),  # block-lot of the rows that name it, parted by "; "
    ("joined_block", TEXT),  # where the photograph is put
    ("joined_lot", TEXT),
    ("verdict", TEXT),  # one of VERDICTS
    ("crop", TEXT),  # relative to the city folder
    ("remedy", TEXT),
)
SCHEMA: Final = pa.schema([pa.field(name, kind) for name, kind in COLUMNS])
TO_MEND: Final[tuple[Verdict, ...]] = ("contradicted", "unsure", "silent")  # by people


@dataclass(frozen=True, slots=True)
class Reading:
    """What the three witnesses say of one photograph, and what follows."""

    photo: str
    judged: Judged
    name: Key | None = None
    listed: tuple[Key, ...] = ()
    board: Joined | None = None
    key: str = ""
    crop: str = ""

    def shown(self, crop: str) -> Self:
        """Name the picture of its board."""
        judged = replace(self.judged, remedy=f"{self.judged.remedy} ({crop})")
        return replace(self, crop=crop, judged=judged)

    @property
    def cells(self) -> dict[str, str | float | None]:
        """Write the table's row."""
        seen, put = self.board or Joined(None), self.judged.key
        return {
            "photo": self.photo,
            "key": self.key,
            "name_says": spelled(self.name),
            "board_says": seen.text,
            "read_block": seen.literal[0] if seen.literal else "",
            "read_lot": seen.literal[1] if seen.literal else "",
            "score": seen.score if seen.key else None,
            "runner_up": spelled(seen.runner_up),
            "runner_up_score": seen.runner_up_score if seen.runner_up else None,
            "list_says": "; ".join(map(spelled, self.listed)),
            "joined_block": put[0] if put else "",
            "joined_lot": put[1] if put else "",
            "verdict": self.judged.verdict,
            "crop": self.crop,
            "remedy": self.judged.remedy,
        }


def spelled(key: Key | None) -> str:
    """Write a key in one cell."""
    return "-".join(key) if key else ""


def write(store: Store, readings: Iterable[Reading]) -> None:
    """Write the table, in the order of the photographs' names."""
    waiting = iter(sorted(readings, key=lambda one: one.photo))
    batches = []
    while group := [one.cells for one in islice(waiting, GROUP)]:
        batches.append(pa.RecordBatch.from_pylist(group, SCHEMA))
    table = pa.Table.from_batches(batches, SCHEMA).combine_chunks()
    store.write_bytes(TABLE, tables.parquet_bytes(table))


def counted(readings: Sequence[Reading]) -> dict[str, int]:
    """Count the verdicts that occur, in their order."""
    count = Counter(one.judged.verdict for one in readings)
    return {one: count[one] for one in VERDICTS if count[one]}
