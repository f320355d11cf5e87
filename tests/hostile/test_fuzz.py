"""Whatever bytes a reader is given, it returns a value or says what is wrong.

Few examples are drawn here each time, the same ones; `make fuzz` draws thousands.
"""

import contextlib
import hashlib
import io
import json
import os
import tempfile
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any, Final

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from nostalgin_core import catalogue, photo
from nostalgin_core.records import Front, Photo, Rejection
from pipelines.index import comma, manifest
from pipelines.index.cells import front_from
from pipelines.index.manifest import Manifest, Row, Unusable
from pipelines.models import Models, Unlocked
from pipelines.site.folder import Foreign, written
from pipelines.store import Store, tables
from tests.hostile import artifacts, catalogues, images, pictures
from tests.hostile.case import bounded, marks

Bytes = st.SearchStrategy[bytes]
FEW: Final = 20  # examples, which CI draws
EXAMPLES: Final = int(os.environ.get("NOSTALGIN_FUZZ", FEW))
FUZZ_S: Final = 1800
SHORT: Final = 40  # bytes that are written over others


fuzzed = settings(
    max_examples=EXAMPLES,
    derandomize=EXAMPLES == FEW,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)


timed = pytest.mark.timeout(FUZZ_S)


def marked(name: str) -> Callable[[Any], Any]:
    """Guard a test against hanging, and expect it to fail while it is open."""

    def apply(test: Any) -> Any:
        for mark in marks("fuzz", name, FUZZ_S):
            test = mark(test)
        return test

    return apply


def named(problem: Exception, *words: str) -> None:
    """Insist that an error says one of these words."""
    assert any(word in str(problem) for word in words)


@contextlib.contextmanager
def folder() -> Iterator[Path]:
    with tempfile.TemporaryDirectory() as one:
        yield Path(one)


@st.composite
def mutated(draw: st.DrawFn, whole: Callable[[], list[bytes]]) -> bytes:
    """Cut, flip, repeat, drop and overwrite bytes of something sound."""
    data = bytearray(draw(st.sampled_from(whole())))
    for _ in range(draw(st.integers(1, 6))):
        at = draw(st.integers(0, max(len(data) - 1, 0)))
        kind = draw(st.sampled_from(["cut", "flip", "repeat", "drop", "put", "insert"]))
        some = draw(st.binary(min_size=1, max_size=SHORT))
        if kind == "cut":
            del data[at:]
        elif kind == "flip" and data:
            data[at] ^= 1 << draw(st.integers(0, 7))
        elif kind == "repeat":
            data[at:at] = data[at : at + draw(st.integers(1, 400))]
        elif kind == "drop":
            del data[at : at + draw(st.integers(1, 400))]
        elif kind == "put":
            data[at : at + len(some)] = some
        else:
            data[at:at] = some
    return bytes(data)


@cache
def encodings() -> list[bytes]:
    """Encode a small street in each format and in most of its modes."""
    small = pictures.street((64, 72))
    made = [pictures.encoded(small, kind) for kind in images.CUTS]
    made += [pictures.encoded(small, "JPEG", mode) for mode in ("RGB", "CMYK")]
    made += [pictures.encoded(small, "PNG", mode) for mode in ("P", "RGBA", "LA", "1")]
    made += [pictures.encoded(small, "TIFF", mode) for mode in ("RGB", "1", "CMYK")]
    deflated = {"compression": "tiff_adobe_deflate"}
    made += [pictures.encoded(small, "TIFF", **deflated), pictures.floats("some_nan")]
    made += [pictures.turned(6), pictures.deep(4095, "PNG"), pictures.paged("GIF", 2)]
    return made


@timed
@fuzzed
@given(data=mutated(encodings))
def test_any_bytes_are_a_photo_or_a_rejection(data: bytes) -> None:
    with bounded():
        found = photo.decode(data, name="x.jpg", max_megapixels=4.0)
    if isinstance(found, Rejection):
        assert found.detail.startswith("x.jpg: ")
    else:
        assert isinstance(found, Photo)
        assert found.image.size <= 4e6


@timed
@fuzzed
@given(
    data=st.one_of([st.just(magic) for magic in photo.photo._READERS]), more=st.binary()
)
def test_any_bytes_after_a_magic_are_a_photo_or_a_rejection(
    data: bytes, more: bytes
) -> None:
    with bounded():
        assert isinstance(photo.decode(data + more, name="x"), Photo | Rejection)


@cache
def lists() -> list[bytes]:
    texts = [*catalogues.sound().values()]
    return [text for text in texts if len(text) < 9999]


CELLS: Final = st.text(max_size=20) | st.sampled_from(
    ["", "0", "-1", "1e999", "nan", "\0", "..", "a/b", "9" * 400, " ", "\ud800", "=1"]
)


@timed
@fuzzed
@given(data=mutated(lists) | st.binary(max_size=300))
def test_any_list_is_read_or_refused_in_words(data: bytes) -> None:
    try:
        names, rows = comma.parsed(data)
    except comma.NoTable as problem:
        named(problem, "is", "has", "parts")
        return
    assert len(set(filter(None, names))) == len([*filter(None, names)])
    read = catalogue.read(rows, name="list.csv")
    for one in read.rejections:
        assert one.key.startswith("list.csv row ")
        assert one.detail
    catalogue.fronts(read.entries)
    catalogue.matched(read.entries, ["5_1.png"])


@timed
@fuzzed
@given(data=mutated(lists) | st.binary(max_size=300))
def test_any_mended_manifest_is_read_or_refused_in_words(data: bytes) -> None:
    with folder() as city:
        (city / manifest.CSV).write_bytes(data)
        try:
            found = manifest.read(Store(str(city)))
        except Unusable as problem:
            named(problem, manifest.CSV)
        else:
            assert isinstance(found, Manifest)


@timed
@fuzzed
@given(cells=st.dictionaries(st.sampled_from(manifest.SCHEMA.names), CELLS))
def test_any_row_is_usable_or_told(cells: dict[str, str]) -> None:
    with contextlib.suppress(ValueError):
        assert isinstance(front_from(cells), Front | None)
    with folder() as city:
        texts = {k: v.encode(errors="replace").decode() for k, v in cells.items()}
        row = dict.fromkeys(manifest.SCHEMA.names, "") | texts
        (city / manifest.CSV).write_text(
            comma.written([*row], [row]), encoding="utf-8", newline=""
        )
        found = manifest.read(Store(str(city)))
    assert len(found.rows) + len(found.rejections) == bool(
        "".join(row.values()).strip()
    )
    assert all(isinstance(one, Row) for one in found.rows)


SCALARS: Final = (
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=9)
)
LISTS: Final = st.lists(SCALARS, max_size=4)
JSON: Final = st.one_of(
    *(SCALARS, LISTS, st.lists(LISTS, max_size=4)),
    st.dictionaries(st.text(max_size=9), SCALARS | LISTS, max_size=4),
)


@cache
def locks() -> list[bytes]:
    lock = {
        f"{name}.onnx": hashlib.sha256(b"").hexdigest() for name in ("segment", "x")
    }
    return [json.dumps(lock).encode(), json.dumps(["index.html", "a/b.glb"]).encode()]


@timed
@fuzzed
@given(data=mutated(locks) | JSON.map(lambda one: json.dumps(one).encode()))
def test_any_lock_names_a_hash_or_is_refused_by_name(data: bytes) -> None:
    with folder() as models:
        (models / "models.lock").write_bytes(data)
        try:
            assert isinstance(Models(str(models)).sha256("segment"), str)
        except Unlocked as problem:
            named(problem, "models.lock")


@timed
@fuzzed
@given(data=mutated(locks) | JSON.map(lambda one: json.dumps(one).encode()))
def test_any_record_of_a_site_names_what_is_inside(data: bytes) -> None:
    with folder() as site:
        (site / ".nostalgin.json").write_bytes(data)
        (site / "index.html").touch()
        try:
            names = written(site)
        except Foreign as problem:
            named(problem, str(site))
        else:
            for name in names:
                assert (site / name).resolve().is_relative_to(site.resolve())


@cache
def parquets() -> list[bytes]:
    with folder() as one:
        store = artifacts.kept(one)
        store.keep(
            artifacts.OTHER, Rejection("a.jpg", "photo", "empty file", "copy it")
        )
        sound = [store.read_bytes(name) for name in (artifacts.PATH, artifacts.OTHER)]
    return [*sound, tables.parquet_bytes(pa.table({"facade": ["x"]}))]


@marked("artifact bytes")
@fuzzed
@given(data=mutated(parquets) | st.binary(max_size=300))
def test_any_artifact_is_read_or_told_to_be_damaged(data: bytes) -> None:
    with folder() as city, bounded():
        path = city / artifacts.PATH
        path.parent.mkdir(parents=True)
        path.write_bytes(data)
        store = Store(str(city))
        try:
            verdict = store.verdict(artifacts.PATH)
            if verdict is True:
                assert isinstance(store.read_table(artifacts.PATH), pa.Table)
        except ValueError as problem:
            if not type(problem).__module__.startswith("pipelines."):
                raise


@cache
def tabulated() -> list[bytes]:
    sink = io.BytesIO()
    pq.write_table(
        pa.Table.from_pylist([{"photo": "x.png", "block": "5"}], manifest.SCHEMA), sink
    )
    return [sink.getvalue(), tables.parquet_bytes(pa.table({"photo": [1]}))]


@marked("manifest Parquet bytes")
@fuzzed
@given(data=mutated(tabulated))
def test_any_manifest_for_programs_is_read_or_refused_in_words(data: bytes) -> None:
    with folder() as city, bounded():
        (city / manifest.PARQUET).write_bytes(data)
        try:
            assert isinstance(manifest.read(Store(str(city))), Manifest)
        except Unusable as problem:
            named(problem, "manifest")
