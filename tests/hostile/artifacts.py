"""Artifacts that a disk, a power cut or a hand has damaged."""

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import pyarrow as pa
import pyarrow.parquet as pq

from pipelines.store import Store

STAGES: Final = ("segment", "matte", "rectify", "inpaint", "block", "thumbnail")
PATH: Final = "artifacts/segment/1-00000000/00/0011.parquet"
OTHER: Final = "artifacts/segment/1-00000000/ff/ff11.parquet"
TABLE: Final = pa.table(
    {"facade": [0, 1], "score": [0.5, 0.25], "mask": [b"a" * 999] * 2}
)
ANOTHER: Final = pa.table(
    {"facade": [7, 8], "score": [0.1, 0.1], "mask": [b"b" * 999] * 2}
)

Spoil = Callable[[Path], object]


@dataclass(frozen=True)
class Damage:
    """Something that befalls an artifact's file."""

    name: str
    spoil: Spoil


def kept(folder: Path) -> Store:
    """Keep two artifacts of one stage."""
    store = Store(str(folder))
    store.keep(PATH, TABLE)
    store.keep(OTHER, ANOTHER)
    return store


def cut(share: float) -> Spoil:
    def spoil(path: Path) -> None:
        data = path.read_bytes()
        path.write_bytes(data[: round(share * len(data))])

    return spoil


def zeroed(share: float, count: int = 64) -> Spoil:
    """Write zeros over bytes from a share of the file on."""

    def spoil(path: Path) -> None:
        data = bytearray(path.read_bytes())
        at = min(round(share * len(data)), len(data) - count)
        data[at : at + count] = bytes(count)
        path.write_bytes(bytes(data))

    return spoil


def flipped(share: float) -> Spoil:
    def spoil(path: Path) -> None:
        data = bytearray(path.read_bytes())
        data[round(share * (len(data) - 1))] ^= 1
        path.write_bytes(bytes(data))

    return spoil


def written(data: bytes) -> Spoil:
    return lambda path: path.write_bytes(data)


def swapped(path: Path) -> None:
    """Put the artifact of another photograph in its place."""
    twin = path.parent.parent / "ff" / "ff11.parquet"
    shutil.copyfile(twin, path)


def other_schema(path: Path) -> None:
    pq.write_table(pa.table({"nonsense": ["x"]}), path)


def other_types(path: Path) -> None:
    pq.write_table(pa.table({name: ["x"] for name in TABLE.column_names}), path)


def no_rows(path: Path) -> None:
    pq.write_table(pq.read_table(path).slice(0, 0), path)


def false_verdict(path: Path) -> None:
    """Say of what was made that it was rejected."""
    table = pq.read_table(path)
    marks = {b"nostalgin.verdict": b"rejected"}
    pq.write_table(table.replace_schema_metadata(marks), path)


def all_zeros(path: Path) -> None:
    path.write_bytes(bytes(path.stat().st_size))


def doubled(path: Path) -> None:
    path.write_bytes(path.read_bytes() * 2)


def cases() -> list[Damage]:
    """List all kinds of damage; none of them may be read as if nothing were."""
    return [
        Damage("nothing left", written(b"")),
        Damage("one byte left", cut(0.0005)),
        *(
            Damage(f"cut to {share:.0%}", cut(share))
            for share in (0.1, 0.5, 0.9, 0.999)
        ),
        *(
            Damage(f"64 zeros at {share:.0%}", zeroed(share))
            for share in (0, 0.3, 0.6, 1)
        ),
        *(
            Damage(f"a bit at {share:.0%}", flipped(share))
            for share in (0.1, 0.45, 0.99)
        ),
        Damage("all zeros", all_zeros),
        Damage("words", written(b"no artifact at all " * 99)),
        Damage("magic alone", written(b"PAR1PAR1")),
        Damage("another schema", other_schema),
        Damage("other types", other_types),
        Damage("no rows", no_rows),
        Damage("a false verdict", false_verdict),
        Damage("of another photograph", swapped),
        Damage("twice itself", doubled),
    ]
