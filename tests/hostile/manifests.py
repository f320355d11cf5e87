"""Manifests as hands and programs leave them, in both forms, and their rows."""

import hashlib
import io
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import pyarrow as pa
import pyarrow.parquet as pq

from pipelines.index import manifest
from tests.hostile import catalogues
from tests.hostile.case import Case, Make
from tests.hostile.networks import write_sound

ROW: Final[dict[str, Any]] = {
    "root": "../photos",
    "photo": "5_1.png",
    "credit": "",
    "front_id": "5-1-0",
    "block": "5",
    "lot": "1",
    "ring": 0,
    "side": 0,
    "rank": 0,
    "street": "Elm Street",
    "address": "1",
    "width_m": 10.0,
    "depth_m": None,
    "width_assumed": False,
}
OUTSIDE: Final = "path outside the photo folder"
NONSENSE: Final = "nonsense cell"
FOREIGN: Final = "scheme not allowed"
UNREADABLE: Final = "unreadable file"


@dataclass(frozen=True)
class HostileRow:
    """Cells of a row mended by hand, and why it or its photograph is rejected."""

    called: str
    cells: dict[str, str]
    reason: str = ""

    def told_by(self, key: str, detail: str) -> bool:
        """Tell whether a rejection names an unreadable photograph, and its root."""
        here = {"root": "", "photo": "good/5_1.png"} | self.cells
        ends = (
            f"{here['root'].strip()}{end}" for end in ":;"
        )  # a root may be relative
        return key == here["photo"].strip() and any(end in detail for end in ends)


def built(write: Callable[[Path], object]) -> Make:
    """Build a city whose manifest is hostile."""

    def make(folder: Path) -> list[object]:
        (folder / "city").mkdir()
        write(folder / "city")
        models = write_sound(folder / "models")
        return ["build", "city", "--models", models.name]

    return make


def csv(data: bytes) -> Make:
    return built(lambda city: (city / manifest.CSV).write_bytes(data))


def parquet(data: bytes) -> Make:
    return built(lambda city: (city / manifest.PARQUET).write_bytes(data))


def table(**columns: Any) -> pa.Table:
    """Make a manifest of one row, with other columns in place of its own."""
    own = pa.Table.from_pylist([ROW], manifest.SCHEMA)
    for name, values in columns.items():
        own = own.drop_columns([name])
        if values is not None:
            own = own.append_column(name, values)
    return own


def encoded(made: pa.Table, **options: Any) -> bytes:
    sink = io.BytesIO()
    pq.write_table(made, sink, **options)
    return sink.getvalue()


def unspelt() -> pa.Array:
    """Make a column of text that is no UTF-8."""
    offsets = pa.array([0, 2], pa.int32()).buffers()[1]
    return pa.StringArray.from_buffers(1, offsets, pa.py_buffer(b"\xff\xfe"))


def cut(share: float) -> bytes:
    whole = encoded(table())
    return whole[: round(share * len(whole))]


def zeroed(start: int, end: int) -> bytes:
    whole = bytearray(encoded(table()))
    whole[start:end] = bytes(len(whole[start:end]))
    return bytes(whole)


def sparse(city: Path) -> None:
    with (city / manifest.CSV).open("wb") as file:
        file.write(b"photo,front_id,block,lot\n")
        file.truncate(3 * 1024**3)


def long_schema() -> bytes:
    """Write more columns than any table of people has."""
    more = {f"c{n}": pa.array(["x"]) for n in range(3000)}
    return encoded(pa.table({"photo": pa.array(["../x.jpg"])} | more))


def cases() -> list[Case]:
    """List all hostile manifests; of none is there anything to build."""
    return [*read_as_csv(), *read_as_parquet(), *missing()]


def read_as_csv() -> list[Case]:
    """Take the broken lists of `catalogues`: none names a front."""
    unread = {name: data for name, (data, _) in catalogues.broken().items()}
    return [
        Case(f"CSV: {name}", csv(data), 1, ("manifest.csv",))
        for name, data in (catalogues.foreign() | unread).items()
    ]


def read_as_parquet() -> list[Case]:
    told = ("manifest.parquet", "delete it")
    row = "row 2"
    wide = (row, "width")
    twin = table().append_column("photo", pa.array(["x"]))
    kinds: dict[str, tuple[bytes, tuple[str, ...]]] = {
        "no bytes": (b"", told),
        "magic alone": (b"PAR1", told),
        "magic twice": (b"PAR1PAR1", told),
        "words": (b"PAR1" + b"rubbish " * 99 + b"PAR1", told),
        "a length beyond its file": (b"PAR1" + b"\xff\xff\xff\x7fPAR1", told),
        "cut to a tenth": (cut(0.1), told),
        "cut in half": (cut(0.5), told),
        "cut near its end": (cut(0.99), told),
        "zeros in its columns": (zeroed(4, 68), ("manifest",)),
        "zeros in its footer": (zeroed(-120, -56), ("manifest",)),
        "picture": (catalogues.painted.photo(), told),
        "no rows": (encoded(table().slice(0, 0)), ("it has no rows",)),
        "no columns": (encoded(pa.table({})), ("is empty", "delete it")),
        "block missing": (encoded(table(block=None)), ("lacks the columns block",)),
        "3000 columns": (long_schema(), ("lacks the columns",)),
        "text that is no UTF-8": (encoded(table(block=unspelt())), ("manifest",)),
        "photo no UTF-8": (encoded(table(photo=unspelt())), ("manifest",)),
        "photo upwards": (encoded(table(photo=pa.array(["../x"]))), (row, "leads out")),
        "photo from the root": (encoded(table(photo=pa.array(["/x"]))), (row,)),
        "ring a list": (encoded(table(ring=pa.array([[1]]))), (row, "ring")),
        "ring a date": (encoded(table(ring=pa.array([0], pa.date32()))), (row, "ring")),
        "ring bytes": (encoded(table(ring=pa.array([b"\xff"]))), (row, "ring")),
        "ring yes": (encoded(table(ring=pa.array([True]))), (row, "ring")),
        "ring below zero": (encoded(table(ring=pa.array([-1]))), (row, "ring")),
        "width no number": (
            encoded(table(width_m=pa.array([float("nan")]))),
            wide,
        ),
        "width endless": (
            encoded(table(width_m=pa.array([float("inf")]))),
            wide,
        ),
        "width a record": (
            encoded(table(width_m=pa.array([{"a": 1}]))),
            wide,
        ),
        "all null": (encoded(pa.table({n: pa.nulls(1) for n in ROW})), ("no rows",)),
        "twin columns": (
            encoded(twin),
            ("manifest",),
        ),
    }
    return [
        Case(f"Parquet: {name}", parquet(data), 1, said)
        for name, (data, said) in kinds.items()
    ]


def missing() -> list[Case]:
    none = ("nostalgin index",)
    return [
        Case("no manifest", built(bool), 1, none),
        Case("folder", built(lambda c: (c / manifest.CSV).mkdir()), 1, none),
        Case("endless device", built(device), 1, ("city",)),
        Case("sparse file of 3 GB", built(sparse), 1, ("manifest.csv",)),
        Case("mended and cut off", built(cut_off), 1, ("manifest.csv",)),
    ]


def device(city: Path) -> None:
    (city / manifest.CSV).symlink_to("/dev/zero")


def cut_off(city: Path) -> None:
    """Cut a manifest in both forms within the CSV's columns, as a full disk does."""
    text = ",".join(ROW).encode()[:20]
    mark = {manifest.CSV_HASH: hashlib.sha256(b"").hexdigest().encode()}
    data = encoded(table().replace_schema_metadata(mark))
    (city / manifest.PARQUET).write_bytes(data)
    (city / manifest.CSV).write_bytes(text)


def rows() -> list[HostileRow]:
    """List hostile rows, which a hand adds to a manifest beside good ones."""
    one = HostileRow
    paths = ["/etc/passwd", "../x.jpg", "a/../../x.jpg", "x\0.jpg"]
    there = [
        "..\\nowhere.jpg",
        "c:nowhere.jpg",
    ]  # no files there
    cells = [
        *(("ring", cell) for cell in ("1e30", "100", "0.5", "-1", "one")),
        *(("rank", cell) for cell in ("nan", "10000", "0.5")),
        *(("width_m", cell) for cell in ("nan", "1e999", "-3", "0", "9" * 5000)),
        *(("width_m", cell) for cell in ("1,500", "1_0")),
        *(("depth_m", cell) for cell in ("inf", "401", "deep")),
        *(("width_assumed", "perhaps"), ("block", ""), ("lot", " ")),
    ]
    schemes = ["http://127.0.0.1:9", "ftp://127.0.0.1", "foo://x", "HTTP://x"]
    roots = ["file:///nowhere", "/nowhere", "mailto:x", "\0", "~", "x" * 5000]
    return [
        *(one(f"photo {path!r}", {"photo": path}, OUTSIDE) for path in paths),
        *(one(f"photo {path!r}", {"photo": path}, UNREADABLE) for path in there),
        *(
            one(f"root {root!r}", {"root": root}, "scheme not allowed")
            for root in schemes
        ),
        *(one(f"{name} {cell[:9]}", {name: cell}, NONSENSE) for name, cell in cells),
        *(one(f"root {root[:20]!r}", {"root": root}, UNREADABLE) for root in roots),
        one("photo a folder", {"photo": "good"}, UNREADABLE),
        one("photo nowhere", {"photo": "nowhere.jpg"}, UNREADABLE),
        one("photo a long name", {"photo": "n" * 300}, UNREADABLE),
        one("photo of memory", {"photo": "memory.jpg"}, UNREADABLE),
        one("too many cells", {"beyond": "Manhattan"}, "too many cells"),
        one("neither photo nor front", {"photo": "", "front_id": ""}, "empty row"),
        one("photo without a front", {"front_id": ""}, "no front known"),
        one("block upwards", {"block": "../../outside", "lot": "../.."}),
        one("block a page", {"block": "<script>alert(1)</script>"}),
        one("block of 5000 letters", {"block": "b" * 5000}),
        one(
            "captions",
            {"block": "\u202e\u05d0", "street": "x" * 10_000, "credit": "=1"},
        ),
    ]
