"""Artifacts that were packed are what they were, and damage to one harms no other."""

import hashlib
from dataclasses import replace
from pathlib import Path

import pytest

from nostalgin_core.records import Assignment, Rejection
from pipelines.store import Damaged, packing, tables
from pipelines.store.packing import artifact, pack
from pipelines.store.shelf import ARTIFACT
from pipelines.store.stable import key_of
from pipelines.store.store import Store
from tests.pipelines import gcs, s3
from tests.pipelines.buckets import objects
from tests.pipelines.gcs import google
from tests.pipelines.s3 import bucket

__all__ = ["bucket", "google"]

FOLDER = "artifacts/matte/1-abc"
KEYS = [key_of(str(number)) for number in range(100)]
NO = Rejection("k", "matte", "no facade", "look")


def filled(store: Store) -> Store:
    """Keep a hundred artifacts, every tenth of them a rejection."""
    for number, key in enumerate(KEYS):
        rows = tables.table(Assignment, [Assignment(key, "k", number, 0.5)])
        store.keep(artifact(FOLDER, key), NO if number % 10 == 0 else rows)
    return store


@pytest.fixture
def store(tmp_path: Path) -> Store:
    return filled(Store(str(tmp_path / "city")))


def told(store: Store) -> list[object]:
    """Read all that is kept: verdicts, and rows where there are some."""
    names = [artifact(FOLDER, key) for key in KEYS]
    verdicts = [store.verdict(name) for name in names]
    rows = [
        store.read_table(name, ["facade"]).to_pylist() if made is True else None
        for name, made in zip(names, verdicts, strict=True)
    ]
    return [verdicts, rows]


def files(store: Store) -> list[Path]:
    return [one for one in Path(store.root).rglob("*") if one.is_file()]


def test_what_is_packed_reads_as_before(store: Store) -> None:
    before = told(store)
    assert pack(store, FOLDER) == len(KEYS)
    assert len(files(store)) == 1
    assert told(store) == before
    assert told(replace(store, era="1")) == before
    there = store.listed(FOLDER)
    assert (sorted(there), there.loose) == (sorted(KEYS), frozenset())


def test_the_bytes_of_an_artifact_are_the_same_in_a_pack(store: Store) -> None:
    before = {path.stem: path.read_bytes() for path in files(store)}
    pack(store, FOLDER)
    there = store.listed(FOLDER)
    places = {key: there.find(key) for key in KEYS}
    cut = {key: store.cut(FOLDER, one) for key, one in places.items() if one}
    assert cut == before


def test_the_order_in_which_artifacts_came_changes_no_byte_of_a_pack(
    store: Store, tmp_path: Path
) -> None:
    other = Store(str(tmp_path / "other"))
    for path in sorted(files(store), reverse=True):
        name = path.relative_to(store.root).as_posix()
        other.write_bytes(name, path.read_bytes())
    sums = []
    for one in (store, other):
        pack(one, FOLDER)
        (only,) = files(one)
        sums.append((only.name, hashlib.sha256(only.read_bytes()).hexdigest()))
    assert sums[0] == sums[1]


def test_few_artifacts_are_left_as_they_are(tmp_path: Path) -> None:
    store = Store(str(tmp_path))
    store.keep(artifact(FOLDER, KEYS[0]), NO)
    assert pack(store, FOLDER) == 0
    assert store.verdict(artifact(FOLDER, KEYS[0])) == NO


def test_what_was_kept_since_a_listing_is_found(store: Store) -> None:
    store = replace(store, era="2")
    pack(store, FOLDER)
    assert store.verdict(artifact(FOLDER, KEYS[1])) is True
    name = artifact(FOLDER, key_of("new"))
    assert store.verdict(name) is False
    store.keep(name, NO)
    assert store.verdict(name) == NO


def test_a_packing_that_was_killed_half_way_leaves_nothing_twice(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = told(store)
    with monkeypatch.context() as patched:
        patched.setattr(packing, "remove", lambda *_: None)
        pack(store, FOLDER)
    assert len(files(store)) == len(KEYS) + 1
    assert told(store) == before
    pack(store, FOLDER)
    assert len(files(store)) == 1
    assert told(store) == before


def spoil(path: Path, at: int) -> None:
    data = bytearray(path.read_bytes())
    data[at] ^= 1
    path.write_bytes(data)


def test_damage_in_a_pack_is_of_one_artifact_alone(store: Store) -> None:
    pack(store, FOLDER)
    (path,) = files(store)
    place = store.listed(FOLDER).find(KEYS[5])
    assert place is not None
    spoil(path, place.start + 12)
    name = artifact(FOLDER, KEYS[5])
    with pytest.raises(Damaged):
        store.read_table(name)
    store.drop(name)
    assert store.verdict(name) is False
    others = [artifact(FOLDER, key) for key in KEYS if key != KEYS[5]]
    assert all(store.verdict(one) is not False for one in others)
    filled(store)
    assert store.read_table(name).num_rows == 1


def test_a_pack_whose_index_is_damaged_vouches_for_nothing(store: Store) -> None:
    pack(store, FOLDER)
    (path,) = files(store)
    spoil(path, path.stat().st_size - 100)
    there = store.listed(FOLDER)
    assert (len(list(there)), len(there.broken)) == (0, 1)
    assert store.verdict(artifact(FOLDER, KEYS[5])) is False


def test_packs_lie_in_a_bucket_as_well(bucket: str) -> None:
    store = filled(Store(f"{bucket}/city"))
    before = told(store)
    pack(store, FOLDER)
    assert told(store) == before
    (name,) = objects(bucket, "city")
    assert not ARTIFACT.fullmatch(name)


def test_an_object_is_written_by_one_request(
    bucket: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = s3.requests(monkeypatch)
    Store(f"{bucket}/city").write_bytes("a/b/c", b"1")
    assert asked == ["PUT"]


def test_pieces_are_parted_and_packed_by_whichever_process(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(packing, "PACK_COUNT", 7)
    before = told(store)
    parts = packing.pieces(store, FOLDER)
    assert len(parts) == 15
    assert [sum(one.has(key) for one in parts) for key in KEYS] == [1] * len(KEYS)
    near = replace(store, era="1")  # which lists the folder once, before all pieces
    assert sum(packing.pack_piece(near, one) for one in parts) == len(KEYS)
    assert told(store) == before
    assert not store.listed(FOLDER).loose


@pytest.mark.parametrize(
    "server", ["bucket", pytest.param("google", marks=gcs.needs_server)]
)
def test_a_folder_of_a_bucket_is_dropped_with_all_below_and_nothing_beside(
    server: str, request: pytest.FixtureRequest
) -> None:
    root = request.getfixturevalue(server)
    there = Store(f"{root}/city")
    there.drop_tree("runs/a/passes")  # of which there is none
    for name in ("runs/a/passes/1/x", "runs/a/passes/y", "runs/a/z", "runs/ab"):
        there.write_bytes(name, b"1")
    there.drop_tree("runs/a/passes")
    assert set(objects(root, "city")) == {"runs/a/z", "runs/ab"}
