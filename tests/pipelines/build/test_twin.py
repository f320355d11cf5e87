"""What is shown keeps its tables, whatever comes of a later run over the same."""

import shutil
from pathlib import Path

import pytest

from pipelines.store import Store, runs
from tests.pipelines import painted
from tests.pipelines.cities import built, tree

HERE = ("--stage_seconds=0",)  # no process of its own: it is faster


@pytest.fixture
def city(tmp_path: Path) -> Path:
    """A painted city that was built once."""
    city = painted.write_city(tmp_path)
    built(city, HERE)
    return city


def test_a_run_that_finds_no_photograph_spoils_no_table_of_the_one_that_is_shown(
    city: Path,
) -> None:
    first, shown = tree(city), (city / "CURRENT").read_text().strip()
    record = (city / f"runs/{shown}/run.json").read_bytes()
    shutil.move(city.parent / "photos", city.parent / "elsewhere")
    failed = built(city, HERE)
    assert failed.held
    assert failed.run != shown
    assert len(list(failed.rejections)) >= failed.photos
    after = tree(city)
    assert {name: after[name] for name in first} == first
    shutil.move(city.parent / "elsewhere", city.parent / "photos")
    mended = built(city, HERE)
    assert mended.run == shown
    last = tree(city)
    assert {name: last[name] for name in first} == first
    assert not {name for name in last.keys() - first if f"runs/{shown}" in name}
    assert (city / f"runs/{shown}/run.json").read_bytes() == record


def test_a_run_that_comes_to_something_else_is_another_run(city: Path) -> None:
    first, shown = tree(city), (city / "CURRENT").read_text().strip()
    one = min((city.parent / "photos").iterdir())
    one.write_bytes(b"no picture")
    other = built(city, (*HERE, "--publish_anyway"))
    assert other.run != shown
    assert (city / "CURRENT").read_text().strip() == other.run
    tables = [name for name in first if name.startswith(f"runs/{shown}/")]
    after = tree(city)
    assert all(after[name] == first[name] for name in tables)
    again = built(city, (*HERE, "--publish_anyway"))
    assert again.run == other.run


def test_a_shown_run_whose_table_is_damaged_gives_way_to_one_that_is_whole(
    city: Path,
) -> None:
    shown = (city / "CURRENT").read_text().strip()
    table = city / f"runs/{shown}/facades.parquet"
    data = table.read_bytes()
    table.write_bytes(data[: len(data) // 2])
    again = built(city, HERE)
    assert again.run != shown
    assert (city / "CURRENT").read_text().strip() == again.run
    assert not again.held


@pytest.mark.parametrize("spoilt", [b"", b"../../x"])
def test_a_damaged_pointer_is_named_with_its_remedy_and_written_anew(
    city: Path, spoilt: bytes
) -> None:
    shown = (city / "CURRENT").read_bytes()
    (city / "CURRENT").write_bytes(spoilt)
    with pytest.raises(OSError, match="build again"):
        runs.shown(Store(str(city)))
    built(city, HERE)
    assert (city / "CURRENT").read_bytes() == shown
