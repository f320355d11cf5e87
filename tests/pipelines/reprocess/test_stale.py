"""What is stale is found by its cause, alone, and nothing is written."""

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from pipelines import bounded
from pipelines.index.index import index
from pipelines.index.manifest import Unusable
from pipelines.reprocess import Plan
from pipelines.store import packing, versions
from pipelines.store.store import Store
from tests.pipelines import painted
from tests.pipelines.cities import artifacts, built, tree
from tests.pipelines.reprocess import changing
from tests.pipelines.reprocess.changing import HERE, add, planned


def causes(plan: Plan) -> dict[str, int]:
    return plan.told()["causes"]


def test_nothing_is_stale_of_a_city_that_was_just_built(city: Path) -> None:
    plan = planned(city)
    assert plan.nothing
    assert (plan.photos, plan.blocks, plan.later) == (0, 0, 0)
    assert planned(city, thorough=True).nothing


def test_nothing_that_is_unchanged_is_read(
    city: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    read = Store.read_bytes
    names: list[str] = []

    def told(store: Store, name: str, *more: int) -> bytes:
        names.append(name)
        return read(store, name, *more)

    monkeypatch.setattr(Store, "read_bytes", told)
    assert planned(city).nothing
    assert not [one for one in names if one.endswith((".png", ".jpg"))]


def a_photo_changes(city: Path) -> None:
    changing.change(city, "6_1.png")


def a_photo_comes(city: Path) -> None:
    changing.add(city, "6_2.png", "6_2.png,6,2,Oak Street,4,7")


def a_photo_goes(city: Path) -> None:
    changing.remove(city, "5_2a.png")


def the_folder_moves(city: Path) -> None:
    (city.parent / "photos").rename(city.parent / "pictures")
    index(city.parent / "pictures", city.parent / "list.csv", str(city))


def a_file_goes(city: Path) -> None:
    (city.parent / "photos/5_1.png").unlink()


def people_correct_a_height(city: Path) -> None:
    line = "building_id,what,value\n6-1,height_m,18\n"
    (city / "corrections.csv").write_text(line)


def people_mend_the_manifest(city: Path) -> None:
    path = city / "manifest.csv"
    path.write_text(path.read_text().replace("Oak Street", "Oak Lane"))


def an_artifact_goes(city: Path) -> None:
    artifacts(city, "matte")[0].unlink()


def what_was_compared_goes(city: Path) -> None:
    artifacts(city, "compare")[0].unlink()


def what_was_lent_goes(city: Path) -> None:
    artifacts(city, "borrow")[0].unlink()


def a_model_goes(city: Path) -> None:
    artifacts(city, "block")[0].unlink()


@pytest.mark.parametrize(
    ("happens", "cause", "blocks"),
    [
        (a_photo_changes, {"changed": 1}, 1),
        (a_photo_comes, {"new": 1}, 1),
        (a_photo_goes, {"removed": 1}, 1),
        (a_file_goes, {"removed": 1}, 1),
        (the_folder_moves, {"moved": 4}, 2),
        (people_correct_a_height, {}, 1),
        (people_mend_the_manifest, {}, 1),
        (an_artifact_goes, {"missing": 1}, 1),
        (a_model_goes, {}, 1),
        (what_was_compared_goes, {}, 1),
        (what_was_lent_goes, {"missing": 1}, 1),
    ],
)
def test_what_changed_is_found_and_touches_its_block_alone(
    city: Path, happens: Callable[[Path], None], cause: dict[str, int], blocks: int
) -> None:
    happens(city)
    before = tree(city)
    plan = planned(city)
    assert not plan.nothing
    assert (causes(plan), plan.blocks, plan.blocks_asked) == (cause, blocks, 2)
    assert tree(city) == before  # nothing was written


def test_a_file_that_was_only_touched_is_not_stale(city: Path) -> None:
    os.utime(city.parent / "photos/6_1.png")
    assert planned(city).nothing


def test_a_file_that_can_not_be_read_is_told_once_and_new_when_it_can(
    city: Path,
) -> None:
    path = add(city, "6_9.png", "6_9.png,6,1,Oak Street,10,7.0")
    data = path.read_bytes()
    os.truncate(path, bounded.PHOTO_BYTES + 1)  # a hole: it takes no room
    assert causes(planned(city)) == {"new": 1}
    report = built(city, HERE)
    (why,) = [one for one in report.rejections if one["key"] == path.name]
    assert (why["stage"], why["reason"]) == ("photo", "unreadable file")
    assert planned(city).nothing
    path.write_bytes(data)
    assert causes(planned(city)) == {"new": 1}


@pytest.mark.parametrize("asked", ["stamps", "read_bytes"])
def test_a_root_that_can_not_be_reached_ends_the_plan(
    city: Path, monkeypatch: pytest.MonkeyPatch, asked: str
) -> None:
    os.utime(city.parent / "photos/6_1.png")
    before = tree(city)
    work = getattr(Store, asked)

    def broken(store: Store, told: object, *more: int) -> object:
        if store.root.endswith("photos"):
            raise OSError("curlCode: 7, Couldn't connect to server")
        return work(store, told, *more)

    monkeypatch.setattr(Store, asked, broken)
    with pytest.raises(Unusable, match=r"photos can't be reached: .*run it again"):
        planned(city)
    assert tree(city) == before


def test_other_bytes_of_the_same_size_and_time_are_found_by_hashing(city: Path) -> None:
    path = city.parent / "photos/6_1.png"
    data, stamp = path.read_bytes(), path.stat()
    path.write_bytes(data[:-1] + bytes([data[-1] ^ 1]))
    os.utime(path, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))
    assert planned(city).nothing
    assert causes(planned(city, thorough=True)) == {"changed": 1}


@pytest.mark.parametrize(
    ("stage", "made"),
    [
        ("segment", {"segment": 4, "matte": 4, "rectify": 4}),
        ("rectify", {"rectify": 4}),
        ("inpaint", {}),
    ],
)
def test_a_new_version_sends_back_what_it_made(
    city: Path, monkeypatch: pytest.MonkeyPatch, stage: str, made: dict[str, int]
) -> None:
    monkeypatch.setitem(versions.CODE, stage, 99)
    plan = planned(city)
    assert plan.blocks == 2
    assert {
        n: v for n, v in plan.told()["made"].items() if n not in ("block", "inpaint")
    } == made
    assert plan.told()["made"]["inpaint"] > 0


def test_packed_artifacts_are_found(
    city: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(packing, "LEAST", 1)
    for folder in (city / "artifacts").glob("*/*"):
        packing.pack(Store(str(city)), folder.relative_to(city).as_posix())
    assert planned(city).nothing


def test_a_budget_takes_whole_groups_the_oldest_first(city: Path) -> None:
    for age, name in enumerate(("6_1.png", "5_1.png")):
        changing.change(city, name)
        when = changing.LONG_AGO + age
        os.utime(city.parent / "photos" / name, (when, when))
    plan = planned(city, budget=1)
    assert (plan.photos, plan.later, plan.blocks) == (1, 1, 1)
    again = planned(city, budget=1)
    assert again.redone.tolist() == plan.redone.tolist()
    assert planned(city, budget=2).later == 0


def test_a_city_without_a_run_is_all_new(tmp_path: Path) -> None:
    city = painted.write_city(tmp_path)
    plan = planned(city)
    assert (causes(plan), plan.blocks) == ({"new": 4}, 2)


def test_a_photograph_in_two_blocks_joins_them(city: Path) -> None:
    text = (city.parent / "list.csv").read_text()
    (city.parent / "list.csv").write_text(text + "6_1.png,5,4,Elm Street,7,6\n")
    changing.listed(city)
    built(city, HERE)
    changing.change(city, "5_1.png")
    assert planned(city).blocks == 2
