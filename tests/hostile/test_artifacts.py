"""A damaged artifact is never taken for a sound one, and is made anew."""

import hashlib
from pathlib import Path

import pyarrow as pa
import pytest

from pipelines.site import folder as site_folder
from pipelines.store import Store, Unstored
from tests.hostile import artifacts, folders, networks
from tests.hostile.artifacts import PATH, TABLE, Damage
from tests.hostile.case import BUILD_S, marks, parameters
from tests.hostile.conftest import nostalgin
from tests.pipelines import painted


def found(store: Store, path: str) -> pa.Table | None:
    """Read an artifact; none if it is as good as absent, or told to be damaged."""
    try:
        if store.verdict(path) is False:
            return None
        return store.read_table(path)
    except ValueError as damage:
        if not type(damage).__module__.startswith("pipelines.") or path not in str(
            damage
        ):
            raise
        return None


@pytest.mark.parametrize("damage", parameters("artifact", artifacts.cases()))
def test_no_damage_is_read_as_if_nothing_were(damage: Damage, tmp_path: Path) -> None:
    store = artifacts.kept(tmp_path)
    damage.spoil(tmp_path / PATH)
    assert found(store, PATH) is None
    store.keep(PATH, TABLE)
    again = found(store, PATH)
    assert again is not None
    assert again.equals(TABLE)


def test_a_folder_in_the_place_of_an_artifact_is_told_by_its_name(
    tmp_path: Path,
) -> None:
    store = artifacts.kept(tmp_path)
    (tmp_path / PATH).unlink()
    (tmp_path / PATH / "within").mkdir(parents=True)
    assert found(store, PATH) is None
    with pytest.raises(Unstored, match=r"0011\.parquet"):
        store.keep(PATH, TABLE)


def tree(city: Path) -> dict[str, str]:
    """Hash what a build makes of a city, but for what tells the time."""
    return {
        path.relative_to(city).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for name in ("artifacts", "site")
        for path in sorted((city / name).rglob("*"))
        if path.is_file() and path.name != site_folder.RECORD
    }


HEALED = "a damaged city is built as it was"


@pytest.mark.parametrize(
    "case", [pytest.param(HEALED, marks=marks("artifact", HEALED, BUILD_S))]
)
def test_a_damaged_city_is_built_as_it_was(case: str, tmp_path: Path) -> None:
    """Damage one artifact of each stage, and of the site a model and a thumbnail."""
    city = tmp_path / case
    folders.filled("5_1.png", painted.photo(), tmp_path / "photos")
    networks.write_sound(tmp_path / "models")
    assert nostalgin("index", tmp_path / "photos", "-o", city)[0] == 0
    words = ("build", city, "--models", tmp_path / "models")
    assert nostalgin(*words)[0] == 0
    before = tree(city)
    kinds = artifacts.cases()[:12]
    for number, stage in enumerate(artifacts.STAGES):
        file = max((city / "artifacts" / stage).rglob("*.parquet"), key=size)
        kinds[2 * number].spoil(file)
    for name in ("*.glb", "*.webp"):
        file = max((city / "site").rglob(name), key=size)
        artifacts.zeroed(0.5)(file)
    assert nostalgin(*words)[0] == 0
    assert tree(city) == before


def size(path: Path) -> int:
    return path.stat().st_size
