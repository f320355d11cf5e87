import hashlib
from pathlib import Path

import pytest

from nostalgin_core.records import Assignment, Rejection
from pipelines.store import Damaged, tables
from pipelines.store.stable import key_of
from pipelines.store.store import Store
from pipelines.store.tables import parquet_bytes

ROWS = tables.table(Assignment, [Assignment("993-11-2", "k", 0, 0.93)])
NO = Rejection("k", "matte", "no facade", "look")


@pytest.fixture
def store(tmp_path: Path) -> Store:
    return Store(str(tmp_path / "city"))


def files(store: Store) -> dict[str, str]:
    return {
        str(path.relative_to(store.root)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in Path(store.root).rglob("*")
        if path.is_file()
    }


def test_keys_depend_on_where_the_parts_end() -> None:
    assert key_of("ab", "c") != key_of("a", "bc")
    assert key_of("ab", "c") == key_of("ab", "c")


def test_an_absent_artifact_has_no_verdict(store: Store) -> None:
    assert store.verdict("artifacts/matte/1/aa/aa.parquet") is False


def test_what_was_kept_is_read_back(store: Store) -> None:
    store.keep("a.parquet", ROWS)
    assert store.verdict("a.parquet") is True
    assert store.read_table("a.parquet").to_pylist() == ROWS.to_pylist()


def test_a_rejection_is_an_artifact_too(store: Store) -> None:
    store.keep("a.parquet", NO)
    assert store.verdict("a.parquet") == NO


def test_the_same_rows_give_the_same_bytes(store: Store) -> None:
    store.keep("a.parquet", ROWS)
    first = files(store)
    store.keep("a.parquet", ROWS)
    assert files(store) == first
    assert parquet_bytes(ROWS) == parquet_bytes(ROWS)


@pytest.mark.parametrize("kept", [0, 4, 100])
def test_an_artifact_that_was_cut_short_is_damaged(store: Store, kept: int) -> None:
    store.keep("a.parquet", ROWS)
    path = Path(store.root) / "a.parquet"
    path.write_bytes(path.read_bytes()[:kept])
    with pytest.raises(Damaged):
        store.verdict("a.parquet")


def test_a_folder_whose_name_is_no_text_is_refused(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="not UTF-8"):
        Store(f"{tmp_path}/\udcff").write_bytes("a", b"1")


def test_nothing_half_written_is_left(store: Store) -> None:
    store.keep("deep/down/a.parquet", ROWS)
    assert list(files(store)) == ["deep/down/a.parquet"]


def test_a_failed_write_leaves_nothing_behind(store: Store) -> None:
    in_the_way = Path(store.root, "a")
    (in_the_way / "b").mkdir(parents=True)
    with pytest.raises(OSError, match="a"):
        store.write_bytes("a", b"1")
    assert [file.name for file in Path(store.root).iterdir()] == ["a"]


def test_some_columns_can_be_read_alone(store: Store) -> None:
    store.keep("a.parquet", ROWS)
    assert store.read_table("a.parquet", ["score"]).column_names == ["score"]


def test_a_store_may_be_named_by_a_uri(store: Store) -> None:
    store.write_bytes("a", b"1")
    assert Store(Path(store.root).absolute().as_uri()).read_bytes("a") == b"1"


def test_a_relative_store_lies_in_the_working_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Store("city").write_bytes("a", b"1")
    assert (tmp_path / "city" / "a").read_bytes() == b"1"
