"""What is put into the folder or the list is found on schedule, without handwork."""

import json
import os
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from pipelines import index
from pipelines.cli.program import app
from pipelines.store import Store
from tests.pipelines import painted
from tests.pipelines.cities import tree
from tests.pipelines.reprocess.changing import HERE
from tests.pipelines.reprocess.test_reprocess import assert_equal_to_a_fresh_build

ELM = "5_3.png,5,3,Elm Street,5,9\n"


@pytest.fixture
def wished(city: Path) -> Path:
    """Give a built city that knows what it was indexed with."""
    before = (city / "manifest.parquet").read_bytes()
    words = ["index", str(city.parent / "photos"), "-o", str(city)]
    listed = ["--catalogue", str(city.parent / "list.csv"), "--boards", "none"]
    assert CliRunner().invoke(app, [*words, *listed]).exit_code == 0
    assert (city / "manifest.parquet").read_bytes() == before
    return city


def run(city: Path, command: str, *words: str) -> Result:
    models = ["--models", str(city.parent / "models")]
    beam = HERE if command != "status" and "--dry-run" not in words else ()
    return CliRunner().invoke(app, [command, str(city), *models, *words, *beam])


def once(city: Path) -> Result:
    (city / "schedule.json").unlink(missing_ok=True)
    done = run(city, "schedule", "--cron", "17 3 * * *", "--once")
    (city / "schedule.json").unlink()  # a fresh build has none
    return done


def grow(city: Path) -> None:
    """Put a photograph and its row where it was indexed from."""
    (city.parent / "photos/5_3.png").write_bytes(painted.photo(9))
    path = city.parent / "list.csv"
    path.write_text(path.read_text().replace(",5,3,Elm Street,5,9\n", ELM))


def test_what_came_and_went_is_found_on_schedule(wished: Path) -> None:
    grow(wished)
    (wished.parent / "photos/5_2a.png").unlink()
    with (wished.parent / "list.csv").open("a") as file:
        file.write(",6,2,Oak Street,4,8\n")
    done = once(wished)
    assert done.exit_code == 0, done.output
    other = wished.parent / "indexed"
    index.index(wished.parent / "photos", wished.parent / "list.csv", str(other))
    for name in ("manifest.csv", "manifest.parquet", "readings.parquet"):
        assert (wished / name).read_bytes() == (other / name).read_bytes()
    assert_equal_to_a_fresh_build(wished)


def test_nothing_is_indexed_where_nothing_came(wished: Path) -> None:
    before = {path: path.stat().st_mtime_ns for path in wished.glob("[!.]*.*")}
    assert once(wished).exit_code == 0
    assert {path: path.stat().st_mtime_ns for path in wished.glob("[!.]*.*")} == before


def test_a_dry_run_tells_of_what_came_and_writes_nothing(wished: Path) -> None:
    grow(wished)
    before = tree(wished)
    told = json.loads(run(wished, "reprocess", "--dry-run", "--json").stdout)
    assert told["causes"] == {"new": 1}
    assert tree(wished) == before
    left = run(wished, "reprocess", "--dry-run", "--json", "--no-index")
    assert json.loads(left.stdout)["causes"] == {}


def test_a_manifest_that_was_mended_stays_and_it_is_told(wished: Path) -> None:
    path = wished / "manifest.csv"
    path.write_text(path.read_text().replace("Oak Street", "Oak Avenue"))
    grow(wished)
    done = run(wished, "reprocess")
    assert done.exit_code == 0, done.output
    assert "mended by hand" in done.stderr
    assert "5_3.png" not in path.read_text()
    assert "Oak Avenue" in path.read_text()


@pytest.mark.parametrize("lost", ["photos", "list"])
def test_a_folder_or_a_list_that_is_gone_removes_nothing(
    wished: Path, lost: str
) -> None:
    before = tree(wished)
    if lost == "photos":
        (wished.parent / "photos").rename(wished.parent / "elsewhere")
    else:
        text = (wished.parent / "list.csv").read_text().splitlines()[0]
        strange = f"{text}\nother.png,77,1,Far Street,1,9\n"
        (wished.parent / "list.csv").write_text(strange)
    done = run(wished, "reprocess")
    assert done.exit_code == 1
    assert tree(wished) == before


def test_a_photograph_whose_board_is_read_is_seen_to_change(city: Path) -> None:
    photos, listed = str(city.parent / "photos"), str(city.parent / "list.csv")
    wish = index.Wish.told(photos, catalogue=listed, boards="all")
    ask = index.Ask(lambda _, names: {n: index.Heard() for n in names}, "all")
    index.fulfilled(wish, str(city), ask=ask)
    known = index.known(Store(str(city)))
    assert known is not None
    assert known.looked
    assert not index.outdated(known, str(city))
    os.utime(Path(photos) / "6_1.png", (1, 1))
    assert index.outdated(known, str(city))


def test_what_comes_from_the_web_is_not_asked_for_again(city: Path) -> None:
    wish = index.Wish.told(str(city.parent / "photos"), catalogue="https://a.example/l")
    assert not wish.lasting
    assert index.known(Store(str(city))) is None


def test_the_status_tells_times_failures_and_what_is_stale(wished: Path) -> None:
    record = {"began": "", "ended": "", "cron": "17 3 * * *", "zone": "UTC"}
    times = [
        {"tick": "2026-11-20T03:17:00+00:00", "outcome": "failed", "detail": "full"},
        {"tick": "2026-11-21T03:17:00+00:00", "outcome": "done", "missed": 2},
    ]
    told = json.dumps([record | one for one in times])
    (wished / "schedule.json").write_text(told)
    grow(wished)
    said = run(wished, "status").stdout
    assert "last due 2026-11-21 03:17 UTC: done, made up for 2 missed" in said
    assert "the first 2026-11-22 03:17 UTC" in said
    assert "failed 2026-11-20 03:17 UTC: full" in said
    assert "1 of 5 photographs to be redone (1 new)" in said
    assert "to be redone" not in run(wished, "status", "--brief").stdout
    lines = run(wished, "status", "--json").stdout.splitlines()
    schedule, stale = (json.loads(one) for one in lines[-2:])
    assert schedule["schedule"]["failures"][0]["detail"] == "full"
    assert stale["stale"]["causes"] == {"new": 1}
