"""Workers pack what lies about, with the bytes that one process packs."""

from pathlib import Path

import pyarrow as pa
import pytest

from pipelines import build, stopping
from pipelines.build import tidied
from pipelines.models import Models
from pipelines.store import Store, packing
from pipelines.store.packing import artifact
from pipelines.store.stable import key_of
from pipelines.store.versions import Versions
from tests.pipelines.cities import tree

KEYS = [key_of(str(number)) for number in range(200)]


@pytest.fixture
def versions() -> Versions:
    return Versions.present(Models())


def filled(folder: Path, versions: Versions) -> Store:
    """Keep two hundred artifacts of two stages."""
    store = Store(str(folder))
    for stage in ("segment", "matte"):
        for key in KEYS:
            name = artifact(versions.folder(stage), key)
            store.write_table(name, pa.table({"key": [key]}))
    return store


def test_two_workers_pack_all_and_change_no_byte_of_it(
    tmp_path: Path, versions: Versions, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = filled(tmp_path / "city", versions)
    before = {name: store.read_bytes(name) for name in tree(tmp_path / "city")}
    monkeypatch.setattr(packing, "PACK_COUNT", 25)  # of the driver, which parts them
    monkeypatch.setattr(tidied, "FEW", 1)
    two = build.options(store.root, beam=["--direct_num_workers=2"])
    tidied.tidied(two, store, versions)
    assert len(tree(tmp_path / "city")) == 2 * 200 / 25
    for stage in ("segment", "matte"):
        there = store.listed(versions.folder(stage))
        assert (sorted(there), there.loose) == (sorted(KEYS), frozenset())
        for key in KEYS:
            place = there.find(key)
            assert place is not None
            folder = versions.folder(stage)
            assert store.cut(folder, place) == before[artifact(folder, key)]


def test_whoever_asks_to_end_finds_all_as_it_was(
    tmp_path: Path, versions: Versions, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = filled(tmp_path / "city", versions)
    before = tree(tmp_path)
    monkeypatch.setenv(stopping.VARIABLE, str(tmp_path))
    tidied.tidied(build.options(store.root), store, versions)
    assert tree(tmp_path) == before
