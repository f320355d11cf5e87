"""After `reprocess` a city is what a fresh build of the same input makes of it."""

import json
import multiprocessing
import os
import shutil
import signal
import time
from collections.abc import Callable
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from pipelines import build, reprocess
from pipelines.reprocess import Reprocessed
from pipelines.store import versions
from pipelines.store.store import Store
from tests.pipelines.cities import artifacts, built, tree
from tests.pipelines.reprocess import changing
from tests.pipelines.reprocess.changing import HERE, planned


def redone(city: Path, *beam: str, **asked: bool | int) -> Reprocessed:
    models = str(city.parent / "models")
    options = build.options(str(city), models=models, beam=[*HERE, *beam])
    return reprocess.reprocess(options, **asked)


def fresh(city: Path) -> Path:
    """Build the same input anew, in a folder of its own; the photographs stay."""
    other = city.parent / "fresh"
    shutil.copytree(city.parent / "models", other / "models")
    (other / "city").mkdir()
    told = ("manifest.csv", "manifest.parquet", "corrections.csv", "streets.csv")
    for name in told:
        if (city / name).exists():
            shutil.copy(city / name, other / "city" / name)
    built(other / "city", HERE)
    return other / "city"


def site(city: Path) -> dict[str, str]:
    """Hash what visitors see."""
    files = tree(city / "site")
    named = json.loads((city / "site/.nostalgin.json").read_text())["now"]
    return {name: files[name] for name in named}


def current(city: Path) -> str:
    return (city / "CURRENT").read_text().strip()


def tables(city: Path) -> dict[str, list]:
    """Read the tables of the published run, with the rows as they stand."""
    folder = city / "runs" / current(city)
    return {
        path.name: pq.read_table(path).to_pylist()
        for path in sorted(folder.glob("*.parquet"))
    }


def assert_equal_to_a_fresh_build(city: Path, *, bytes_too: bool = True) -> None:
    other = fresh(city)
    assert site(city) == site(other)
    assert tables(city) == tables(other)
    if bytes_too:
        assert current(city) == current(other)
        mine, theirs = (tree(one / "runs" / current(city)) for one in (city, other))
        assert {n: h for n, h in mine.items() if "metrics" not in n} == {
            n: h for n, h in theirs.items() if "metrics" not in n
        }
    kept = tree(city)
    assert [n for n in tree(other) if "artifacts" in n and n not in kept] == []


def a_photo_comes(city: Path) -> None:
    changing.add(city, "6_2.png", "6_2.png,6,2,Oak Street,4,7")


def a_photo_goes(city: Path) -> None:
    changing.remove(city, "5_2a.png")


def people_correct_a_height(city: Path) -> None:
    line = "building_id,what,value\n6-1,height_m,18\n"
    (city / "corrections.csv").write_text(line)


@pytest.mark.parametrize(
    "happens", [a_photo_comes, a_photo_goes, people_correct_a_height]
)
def test_the_city_is_what_a_fresh_build_makes(
    city: Path, happens: Callable[[Path], None]
) -> None:
    happens(city)
    done = redone(city)
    assert done.shown
    assert done.plan.blocks == 1
    assert_equal_to_a_fresh_build(city)
    assert planned(city).nothing


def test_a_photograph_under_an_old_name_shows_in_a_run_of_another_name(
    city: Path,
) -> None:
    before = current(city)
    old = tree(city / "runs" / before)
    changing.change(city, "6_1.png")
    assert redone(city).shown
    assert current(city) != before
    assert tree(city / "runs" / before) == old  # which may be shown again
    assert_equal_to_a_fresh_build(city, bytes_too=False)


def test_a_file_that_is_no_photograph_is_not_stale_for_ever(city: Path) -> None:
    (city.parent / "photos/6_1.png").write_bytes(b"no picture")
    assert redone(city).shown
    assert planned(city).nothing


def test_a_new_version_remakes_all_that_follows_from_it(
    city: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(versions.CODE, "rectify", 99)
    made = {path: path.stat().st_mtime_ns for path in artifacts(city, "matte")}
    assert redone(city).shown
    assert {p: p.stat().st_mtime_ns for p in artifacts(city, "matte")} == made
    assert_equal_to_a_fresh_build(city)


def test_two_processes_make_the_same(city: Path) -> None:
    changing.add(city, "6_2.png", "6_2.png,6,2,Oak Street,4,7")
    options = build.options(
        str(city), models=str(city.parent / "models"), beam=["--direct_num_workers=2"]
    )
    assert reprocess.reprocess(options).shown
    assert_equal_to_a_fresh_build(city)


def test_what_is_missing_or_damaged_is_made_again_and_the_run_stays(city: Path) -> None:
    before = tree(city)
    artifacts(city, "matte")[0].unlink()
    spoiled = artifacts(city, "segment")[0]
    data = bytearray(spoiled.read_bytes())
    data[40] ^= 255
    spoiled.write_bytes(data)
    done = redone(city, thorough=True)
    assert not done.shown
    assert tree(city) == before


def test_nothing_is_written_where_nothing_is_stale(city: Path) -> None:
    before = {p: p.stat().st_mtime_ns for p in city.rglob("*") if p.name != ".lock"}
    done = redone(city)
    assert (done.report, done.plan.photos) == (None, 0)
    after = {p: p.stat().st_mtime_ns for p in city.rglob("*") if p.name != ".lock"}
    assert after == before


def test_an_untouched_block_is_neither_opened_nor_written(
    city: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    changing.change(city, "6_1.png")
    models = {p: p.stat().st_mtime_ns for p in (city / "site/blocks").glob("5-*")}
    (path,) = (
        row["model"] for row in tables(city)["blocks.parquet"] if row["block"] == "5"
    )
    opened: list[str] = []
    read = Store.read_table

    def told(store: Store, name: str, *more: object) -> object:
        opened.append(name)
        return read(store, name, *more)

    monkeypatch.setattr(Store, "read_table", told)
    assert redone(city).shown
    assert path not in opened
    assert models
    assert {
        p: p.stat().st_mtime_ns for p in (city / "site/blocks").glob("5-*")
    } == models


def killed(city: Path, artifact: str) -> None:
    """Reprocess in a process that is killed as soon as an artifact is there."""
    context = multiprocessing.get_context("fork")
    before = len(artifacts(city, artifact))
    child = context.Process(target=redone, args=(city,))
    child.start()
    while child.is_alive() and len(artifacts(city, artifact)) == before:
        time.sleep(0.01)
    if child.pid is not None and child.is_alive():
        os.kill(child.pid, signal.SIGKILL)
    child.join()


@pytest.mark.parametrize("stage", ["segment", "block"])
def test_killed_and_started_again_it_makes_the_same(city: Path, stage: str) -> None:
    changing.add(city, "6_2.png", "6_2.png,6,2,Oak Street,4,7")
    shown = current(city)
    killed(city, stage)
    assert current(city) == shown
    assert redone(city).shown
    assert_equal_to_a_fresh_build(city)


def test_a_budget_shows_what_is_done_and_comes_to_the_same_end(city: Path) -> None:
    for age, name in enumerate(("6_1.png", "5_1.png")):
        changing.change(city, name)
        when = changing.LONG_AGO + age
        os.utime(city.parent / "photos" / name, (when, when))
    first = redone(city, budget=1)
    assert (first.shown, first.plan.photos, first.plan.later) == (True, 1, 1)
    second = redone(city, budget=1)
    assert (second.shown, second.plan.photos, second.plan.later) == (True, 1, 0)
    assert_equal_to_a_fresh_build(city, bytes_too=False)


def test_of_a_new_version_a_budget_makes_artifacts_ahead_and_shows_none(
    city: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(versions.CODE, "matte", 99)
    shown = current(city)
    first = redone(city, budget=1)
    assert (first.shown, current(city)) == (False, shown)
    assert 0 < first.plan.later < 4
    assert planned(city).photos < 4
    assert redone(city).shown
    assert_equal_to_a_fresh_build(city)
