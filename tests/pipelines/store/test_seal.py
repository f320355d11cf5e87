import io
from pathlib import Path

import pyarrow as pa
import pytest

from nostalgin_core.records import Rejection
from pipelines.store import seal, tables
from pipelines.store.seal import Damaged
from pipelines.store.store import Store

TABLE = pa.table(
    {
        "name": ["a", "b", None],
        "picture": [b"\x89PNG" * 40, b"", None],
        "numbers": [[1.0, 2.0], [], None],
    }
)


def read(data: bytes, columns: list[str] | None = None) -> list[dict[str, object]]:
    with pa.BufferReader(data) as file:
        return seal.read(seal.opened(file), columns).to_pylist()


def test_the_same_rows_give_the_same_bytes_which_give_the_rows() -> None:
    assert seal.sealed(TABLE) == seal.sealed(TABLE)
    assert read(seal.sealed(TABLE)) == TABLE.to_pylist()
    assert read(seal.sealed(TABLE), ["name"]) == TABLE.select(["name"]).to_pylist()


def test_no_changed_byte_changes_what_is_read() -> None:
    whole = seal.sealed(TABLE)
    found = 0
    for at in range(len(whole)):
        for flip in (0x01, 0x80, 0xFF):
            changed = bytearray(whole)
            changed[at] ^= flip
            try:
                assert read(bytes(changed)) == TABLE.to_pylist(), (at, flip)
            except Damaged:
                found += 1
    assert found > 2 * len(whole)  # but for what no reader looks at


@pytest.mark.parametrize("size", [64, 4096])
def test_zeroed_bytes_are_found_out_wherever_they_lie(size: int) -> None:
    whole = seal.sealed(TABLE)
    for at in range(0, len(whole) - 4, 16):
        changed = whole[:at] + bytes(min(size, len(whole) - at)) + whole[at + size :]
        with pytest.raises(Damaged):
            read(changed)


def test_a_file_cut_anywhere_is_found_out() -> None:
    whole = seal.sealed(TABLE)
    for kept in range(len(whole)):
        with pytest.raises(Damaged):
            read(whole[:kept])


def test_parquet_of_another_is_damaged() -> None:
    sink = io.BytesIO()
    pa.parquet.write_table(TABLE, sink)
    with pytest.raises(Damaged, match="no seal"):
        read(sink.getvalue())


def test_a_damaged_artifact_is_named(tmp_path: Path) -> None:
    store = Store(str(tmp_path))
    store.keep("a.parquet", tables.table(Rejection, [Rejection("k", "s", "r", "d")]))
    path = tmp_path / "a.parquet"
    path.write_bytes(path.read_bytes()[:-1])
    with pytest.raises(Damaged, match=r"a\.parquet is damaged"):
        store.read_table("a.parquet")
    with pytest.raises(Damaged) as raised:
        store.verdict("a.parquet")
    assert raised.value.name == "a.parquet"
