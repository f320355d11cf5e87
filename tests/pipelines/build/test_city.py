"""The pipeline on a painted city: same bytes however it is run, and nothing lost."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from nostalgin_core import reconstruct
from nostalgin_core.steps import Networks
from pipelines.build import Lost
from pipelines.index import asked, manifest
from pipelines.models import Models
from pipelines.site.folder import Foreign
from pipelines.site.publish import publish
from pipelines.store.store import Store
from pipelines.store.versions import Versions
from tests.pipelines import painted
from tests.pipelines.cities import artifacts, built, copied, tree
from tests.pipelines.told import told_blocks, told_buildings

TWO_PROCESSES = ("--direct_num_workers=2",)


def test_every_photo_gives_facades_and_every_lot_a_building(city: Path) -> None:
    report = built(city)
    assert (report.photos, report.rejected_photos) == (4, 0)
    assert (report.blocks, report.buildings, report.assumed) == (2, 4, 1)


def test_two_processes_write_the_same_bytes(city: Path, tmp_path: Path) -> None:
    other = copied(city, tmp_path)
    built(other, TWO_PROCESSES)
    assert tree(other) == tree(city)


def test_a_second_run_makes_nothing_and_changes_nothing(city: Path) -> None:
    before = tree(city)
    written = {path: path.stat().st_mtime_ns for path in artifacts(city, "")}
    built(city)
    assert tree(city) == before
    assert {p: p.stat().st_mtime_ns for p in artifacts(city, "")} == written


def test_a_run_that_was_cut_off_goes_on_to_the_same_bytes(
    city: Path, tmp_path: Path
) -> None:
    other = copied(city, tmp_path)
    shutil.copytree(city / "artifacts", other / "artifacts")
    for stage in ("matte", "rectify", "inpaint"):
        for path in artifacts(other, stage)[::2]:
            path.unlink()
    shutil.rmtree(other / "artifacts" / "block")
    found = {p: p.stat().st_mtime_ns for p in artifacts(other, "segment")}
    built(other)
    assert tree(other) == tree(city)
    assert {p: p.stat().st_mtime_ns for p in artifacts(other, "segment")} == found


def test_shards_and_one_last_run_equal_one_run(city: Path, tmp_path: Path) -> None:
    other = copied(city, tmp_path)
    parts = [built(other, shard=f"{k}/3") for k in (1, 2, 3)]
    assert sum(part.photos for part in parts) == 4
    assert not (other / "CURRENT").exists()
    made = {path: path.stat().st_mtime_ns for path in artifacts(other, "")}
    built(other)
    assert {p: p.stat().st_mtime_ns for p in artifacts(other, "")} == made
    same = tree(other)
    assert {name: same[name] for name in tree(city)} == tree(city)


def test_the_pipeline_equals_the_plain_loop(city: Path) -> None:
    rows = [r for r in manifest.read(Store(str(city))).rows if r.front is not None]
    mine = [row for row in rows if row.front and row.front.block == "5"]
    photos: dict[str, tuple[bytes, list[str]]] = {}
    for row in mine:
        if row.photo and row.front:
            data = (Path(row.root) / row.photo).read_bytes()
            photos.setdefault(row.photo, (data, []))[1].append(row.front.front_id)
    fronts = list({row.front.front_id: row.front for row in mine if row.front}.values())
    models = Models(str(city.parent / "models"))
    networks = Networks(models.load("segment"), models.load("inpaint"))
    oracle = reconstruct.rebuild("5", fronts, photos, networks)
    glbs = [pq.read_table(p).to_pylist()[0] for p in artifacts(city, "block")]
    assert {row["block"]: row["glb"] for row in glbs}["5"] == oracle.glb


def test_the_best_of_several_photos_is_worn_and_the_others_are_kept(city: Path) -> None:
    assert len(artifacts(city, "rectify")) == 4
    assert len(artifacts(city, "inpaint")) == 3


@pytest.mark.parametrize(
    ("title", "shown"),
    [("Midtown,\n1940 <b>", "Midtown, 1940 <b>"), ("", "Main street"), ("\n", None)],
)
def test_the_site_shows_the_title_or_the_folder_s_name(
    city: Path, tmp_path: Path, title: str, shown: str | None
) -> None:
    other = tmp_path / "main-street"
    shutil.copytree(city, other)
    store = Store(str(other))
    models = Models(str(city.parent / "models"))
    run = (other / "CURRENT").read_text().strip()
    publish(store, run, Versions.present(models), title=title)
    record = json.loads((other / "site" / "site.json").read_text())
    assert record["title"] == (shown or "Main street")


def test_each_photo_is_credited_to_whom_its_own_row_names(
    city: Path, tmp_path: Path
) -> None:
    other = tmp_path / "city"
    shutil.copytree(city, other)
    store = Store(str(other))
    rows = manifest.read(store).rows
    rows = [replace(row, credit=f"Archive of {row.photo}") for row in rows]
    run = (other / "CURRENT").read_text().strip()
    asked.written(store, run, asked.told_as(rows))
    publish(store, run, Versions.present(Models(str(city.parent / "models"))))
    photos = [p for one in told_buildings(other / "site") for p in one["photos"]]
    assert len(photos) >= 4
    assert all(one["credit"] == f"Archive of {one['caption']}" for one in photos)


def test_a_manifest_that_was_mended_by_hand_is_built_and_written_anew(
    city: Path, tmp_path: Path
) -> None:
    shutil.copytree(city.parent / "models", tmp_path / "models")
    other = tmp_path / "city"
    shutil.copytree(city, other)
    text = (other / manifest.CSV).read_text()
    (other / manifest.CSV).write_text(text.replace("Elm Street", "Oak Street"))
    assert manifest.read(Store(str(other))).mended
    first = built(other)
    assert not manifest.read(Store(str(other))).mended
    assert built(other).run == first.run
    (block, _) = told_blocks(other / "site")
    assert {one["street"] for one in block["buildings"]} == {"Oak Street"}


def test_two_folders_may_hold_photos_of_one_name(city: Path, tmp_path: Path) -> None:
    shutil.copytree(city.parent / "models", tmp_path / "models")
    other = tmp_path / "city"
    shutil.copytree(city, other)
    shutil.copytree(city.parent / "photos", tmp_path / "more")
    shutil.copy(tmp_path / "more" / "6_1.png", tmp_path / "more" / "5_1.png")
    rows = pq.read_table(other / manifest.PARQUET).to_pylist()
    for row in rows:
        if row["photo"] == "6_1.png":
            row.update(root="../more", photo="5_1.png", credit="Another archive")
    manifest.write(Store(str(other)), rows)
    report = built(other)
    assert (report.photos, report.rejected_photos, report.assumed) == (4, 0, 1)
    named = [
        photo["credit"]
        for building in told_buildings(other / "site")
        for photo in building["photos"]
        if photo["caption"] == "5_1.png"
    ]
    assert sorted(named) == ["", "Another archive"]


@pytest.mark.parametrize("workers", [1, 2])
def test_a_folder_that_takes_no_artifacts_fails_the_run_and_blames_no_photo(
    city: Path, tmp_path: Path, workers: int
) -> None:
    other = copied(city, tmp_path)
    shutil.copytree(city / "artifacts", other / "artifacts")
    shutil.rmtree(other / "artifacts/matte")
    (other / "artifacts/matte").write_text("a file where a folder should be")
    with pytest.raises(Lost, match=r"takes no more artifacts.*artifacts/matte"):
        built(other, [f"--direct_num_workers={workers}"])
    assert not (other / "CURRENT").exists()


def test_a_site_of_another_is_told_before_the_work_and_stays_as_it_is(
    city: Path, tmp_path: Path
) -> None:
    other = copied(city, tmp_path)
    (other / "site/photos").mkdir(parents=True)
    (other / "site/photos/original.jpg").write_text("mine")
    before = tree(other)
    with pytest.raises(Foreign, match="move them elsewhere"):
        built(other)
    assert tree(other) == before


def test_clock_times_stand_in_one_file_alone(city: Path) -> None:
    run = (city / "CURRENT").read_text().strip()
    told = json.loads((city / "runs" / run / "run.json").read_text())
    assert set(told["stages"]) >= {"photo", "segment", "matte", "rectify", "inpaint"}
    assert told["stages"]["segment"]["made"] == 4
    assert "milliseconds" in told["stages"]["rectify"]


BAD_FILES = {
    "truncated.jpg": painted.photo(1, suffix=".jpg")[:2000],
    "empty.jpg": b"",
    "words.jpg": b"this is no photograph at all\n" * 9,
    "huge.png": b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR"
    + (60_000).to_bytes(4, "big") * 2
    + b"\x08\x00\x00\x00\x00\x9d\x19\xd5\x9b\x00\x00\x00\x00",
}


def test_bad_files_are_rejected_by_name_and_harm_nothing(
    city: Path, tmp_path: Path
) -> None:
    other = copied(city, tmp_path)
    shutil.copytree(city / "artifacts", other / "artifacts")
    for name, data in BAD_FILES.items():
        (city.parent / "photos" / name).write_bytes(data)
    rows = pq.read_table(other / manifest.PARQUET).to_pylist()
    good = next(row for row in rows if row["photo"])
    bad = [*BAD_FILES, "missing.jpg", "../outside.jpg"]
    rows += [good | {"photo": name} for name in bad]
    manifest.write(Store(str(other)), rows)
    report = built(other)
    reasons = {row["key"]: row for row in report.rejections}
    for name in [*BAD_FILES, "missing.jpg"]:
        assert reasons[name]["stage"] in ("photo", "segment"), reasons
        assert reasons[name]["reason"] != "crashed"
    (row,) = [row for row in reasons.values() if row["stage"] == "manifest"]
    assert row["key"].startswith("manifest.csv row")
    assert "../outside.jpg" in row["detail"]
    assert (report.blocks, report.buildings, report.assumed) == (2, 4, 1)
    same = tree(other)
    for name, digest in tree(city).items():
        if name.startswith("artifacts"):
            assert same[name] == digest, name
