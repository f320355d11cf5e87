"""What a kept run refers to stays, byte for byte; all else goes."""

import json
import shutil
from pathlib import Path

import pytest

from pipelines.store import Store, packing
from pipelines.store.refuse import Unknown, drop_unkept
from tests.pipelines import painted
from tests.pipelines.cities import artifacts, built, tree

HERE = ("--stage_seconds=0",)


@pytest.fixture(scope="module")
def city(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A city that was built, and built again after a photo was lost from its list."""
    city = painted.write_city(tmp_path_factory.mktemp("painted"))
    first = built(city, HERE).run
    listed = city / "manifest.csv"
    lines = [one for one in listed.read_text().splitlines() if "6_1.png" not in one]
    listed.write_text("\n".join(lines) + "\n")
    assert built(city, HERE).run != first
    return city


@pytest.fixture
def other(city: Path, tmp_path: Path) -> Path:
    shutil.copytree(city.parent / "models", tmp_path / "models")
    return Path(shutil.copytree(city, tmp_path / "city"))


def test_nothing_goes_while_every_run_is_kept(other: Path) -> None:
    before = tree(other)
    done = drop_unkept(Store(str(other)), keep=9)
    assert (done.artifacts, done.runs) == (0, ())
    assert tree(other) == before


def test_after_one_build_nothing_goes_and_the_next_makes_nothing(
    tmp_path: Path,
) -> None:
    other = painted.write_city(tmp_path)
    built(other, HERE)
    assert artifacts(other, "compare")
    made = {path: path.stat().st_mtime_ns for path in artifacts(other, "")}
    assert drop_unkept(Store(str(other)), keep=0).artifacts == 0
    built(other, HERE)
    assert {p: p.stat().st_mtime_ns for p in artifacts(other, "")} == made


def test_a_dry_run_drops_nothing(other: Path) -> None:
    before = tree(other)
    assert drop_unkept(Store(str(other)), dry=True).artifacts > 0
    assert tree(other) == before


@pytest.mark.parametrize("packs", [False, True])
def test_what_the_published_run_needs_stays(
    other: Path, monkeypatch: pytest.MonkeyPatch, *, packs: bool
) -> None:
    monkeypatch.setattr(packing, "LEAST", 1)
    store = Store(str(other))
    if packs:
        for folder in (other / "artifacts").glob("*/*"):
            packing.pack(store, folder.relative_to(other).as_posix())
    wanted = drop_unkept(store, keep=0, dry=True)
    done = drop_unkept(store, keep=0)
    assert done == wanted
    assert done.artifacts >= 5  # of the photo that is gone, a stage each, and its block
    assert drop_unkept(store, keep=0).artifacts == 0
    made = {path: path.stat().st_mtime_ns for path in artifacts(other, "")}
    monkeypatch.setattr(packing, "LEAST", 1000)
    assert built(other, HERE).run == done.kept_runs[0]
    assert {p: p.stat().st_mtime_ns for p in artifacts(other, "")} == made


def test_a_run_that_does_not_tell_what_it_needs_stops_it(other: Path) -> None:
    (current,) = (other / "CURRENT").read_text().split()
    record = other / "runs" / current / "run.json"
    told = json.loads(record.read_text())
    record.write_text(
        json.dumps({n: one for n, one in told.items() if n != "versions"})
    )
    before = tree(other)
    with pytest.raises(Unknown, match="build once more"):
        drop_unkept(Store(str(other)))
    assert tree(other) == before
