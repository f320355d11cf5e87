"""Shapes that people drew: refused by row, obeyed by a build, and told."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from nostalgin_core import reconstruct, steps
from nostalgin_core.records import Drawn, Elevation, Facade
from nostalgin_core.steps import Networks
from pipelines import corrections
from pipelines.build.corrected import corrected
from pipelines.cli import app
from pipelines.corrections import shapes
from pipelines.index import manifest, source
from pipelines.index.row import Refused
from pipelines.models import Models
from pipelines.store import Store, tables
from pipelines.store.refuse import drop_unkept
from tests.pipelines import painted
from tests.pipelines.cities import artifacts, built, tree

HEAD = "photo,front_id,building_id,what,value,note\n"
MASK = "45,90 265,145 268,555 44,590"
QUAD = "45,90 265,145 268,555 44,590"


def refusals(city: Path, *lines: str) -> list[tuple[str, str, str]]:
    (city / "corrections.csv").write_text(HEAD + "\n".join(lines) + "\n")
    store = Store(str(city))
    rows = manifest.read(store).rows
    made = corrections.applied(rows, corrections.read(store))
    made = corrections.fitting(made, store)
    assert not made.changes
    assert not made.outlines
    assert not made.quads
    return [(one.key, one.reason, one.detail) for one in made.rejections]


@pytest.mark.parametrize(
    ("what", "value", "said"),
    [
        ("mask", "10,10 200,200 200,10 10,200", "crosses or touches itself"),
        ("mask", "10,10 200,10 200,200", "has 3 points: a front has four corners"),
        ("mask", "10,10 nan,10 200,200 10,200", "has 'nan', which is no number"),
        ("mask", "10,10 inf,10 200,200 10,200", "has a number beyond"),
        ("mask", "10,10 200,10 200,200 10", "a number without a partner"),
        ("mask", "10,10 200,ten 200,200 10,200", "has 'ten', which is no number"),
        ("mask", "10,10 20,10 20,20 10,20", "covers 100 pixels"),
        ("mask", "1,2 " * 1_001, "points, more than 1,000"),
        ("mask", "", "has 0 points"),
        ("quad", "10,10 200,10 200,200", "has 3 corners: a quad has four"),
        ("quad", "10,10 200,10 200,200 10,200 5,100", "has 5 corners"),
        ("quad", "10,10 200,10 60,60 10,200", "a corner that is none"),
        ("quad", "10,10 100,10 200,10 100,200", "a corner that is none"),
        ("quad", "10,10 20,10 20,200 10,200", "a side of 10 pixels"),
        ("quad", "1e9,10 20,10 20,200 10,200", "has a number beyond"),
    ],
)
def test_a_bad_shape_is_refused_by_its_row(
    city: Path, what: str, value: str, said: str
) -> None:
    ((key, reason, detail),) = refusals(city, f'5_1.png,,,{what},"{value}",')
    assert (key, reason) == ("corrections.csv row 2", "nonsense correction")
    assert said in detail


def test_a_million_points_are_refused_in_words(city: Path) -> None:
    points = [[n % 600, n % 400] for n in range(1_000_000)]
    line = json.dumps({"photo": "5_1.png", "what": "mask", "value": points})
    (city / "corrections.csv").unlink(missing_ok=True)
    (city / "corrections.jsonl").write_text(line + "\n")
    (rejection,) = corrections.read(Store(str(city))).rejections
    (city / "corrections.jsonl").unlink()
    assert "1,000,000 points, more than 1,000" in rejection.detail


@pytest.mark.parametrize(
    ("what", "value"),
    [
        ("mask", "10,10 900,10 900,200 10,200"),
        ("mask", "-50,10 200,10 200,200 -50,200"),
        ("quad", "10,10 900,10 900,200 10,200"),
        ("quad", "700,10 710,200 690,200 650,20"),
    ],
)
def test_a_shape_beyond_its_photo_is_refused(city: Path, what: str, value: str) -> None:
    ((key, reason, detail),) = refusals(city, f'5_1.png,,,{what},"{value}",')
    assert key == "corrections.csv row 2"
    assert (reason, "480 x 640" in detail) == ("outside its photo", True) or (
        "nonsense correction" in reason
    )


@pytest.mark.parametrize(
    ("x", "obeyed"), [(479, {"5_1.png": 479.0}), (480, {}), (99999, {})]
)
def test_a_target_beyond_its_photo_is_refused(
    city: Path, x: int, obeyed: dict[str, float]
) -> None:
    """The photo is 480 pixels wide, so that its last column is 479."""
    store = Store(str(city))
    (city / "corrections.csv").write_text(f"{HEAD}5_1.png,,,target,{x},\n")
    made = corrected(store, source.found(store))
    assert made.targets_px == obeyed
    refused = [one.why for one in made.rows or () if isinstance(one, Refused)]
    said = [(one.reason, f"x = {x} " in one.detail) for one in refused]
    assert said == ([] if obeyed else [("outside its photo", True)])


def test_a_shape_of_no_photo_is_refused(city: Path) -> None:
    ((_, reason, _),) = refusals(city, f'9_9.png,,,mask,"{MASK}",')
    assert reason == "no such photo"


def test_the_corners_of_a_quad_may_be_written_in_any_order() -> None:
    corners = shapes.quad(QUAD)
    for turned in (np.roll(corners, 1, axis=0), corners[::-1], corners[[0, 2, 1, 3]]):
        assert np.array_equal(shapes.quad(shapes.written(turned)), corners)
    assert corners[0].tolist() == [45, 90]


def test_points_are_written_as_they_are_read() -> None:
    points = shapes.outline("10.126,20 200,20.5 200,300 10,300")
    assert np.abs(shapes.read(shapes.written(points)) - points).max() < 0.0051
    assert shapes.written(shapes.read("-0.001,0 1,1")) == shapes.written(
        shapes.read("0,0 1,1")
    )


def write(city: Path) -> None:
    lines = [
        {"photo": "5_1.png", "what": "mask", "value": MASK},
        {"photo": "5_1.png", "what": "quad", "value": [[45, 90], [265, 145]]},
        {"photo": "5_1.png", "what": "quad", "value": QUAD, "note": "by eye"},
    ]
    text = "".join(json.dumps(one) + "\n" for one in lines)
    (city / "corrections.jsonl").write_text(text)


def test_a_build_does_again_what_a_shape_touches_and_nothing_else(other: Path) -> None:
    before, first = tree(other), built(other)
    write(other)
    report = built(other)
    assert report.run != first.run
    after = tree(other)
    made = [name for name in after if name not in before and "artifacts/" in name]
    stages = sorted(name.split("/")[1] for name in made)
    assert stages == ["block", "compare", "inpaint", "matte", "rectify"]  # one of each
    same = [name for name in before if name.startswith("artifacts/")]
    assert all(after[name] == before[name] for name in same)
    built(other)
    assert {name for name in tree(other) if "artifacts/" in name} == {*same, *made}


def test_a_build_equals_the_plain_loop_and_the_front_is_what_was_asked(
    other: Path,
) -> None:
    old = {path for stage in ("matte", "rectify") for path in artifacts(other, stage)}
    glbs = set(artifacts(other, "block"))
    write(other)
    built(other)
    fresh = [p for s in ("matte", "rectify") for p in artifacts(other, s)]
    matte, rectify = [path for path in fresh if path not in old]
    store = Store(str(other))
    rows = [r for r in manifest.read(store).rows if r.front and r.front.block == "5"]
    photos: dict[str, tuple[bytes, list[str]]] = {}
    for row in rows:
        if row.photo and row.front:
            data = (Path(row.root) / row.photo).read_bytes()
            photos.setdefault(row.photo, (data, []))[1].append(row.front.front_id)
    models = Models(str(other.parent / "models"))
    networks = Networks(models.load("segment"), models.load("inpaint"))
    drawn = Drawn(shapes.outline(MASK), shapes.quad(QUAD))
    name = "5_1.png"
    loop = steps.photograph(photos[name][0], networks, name=name, drawn=drawn)
    assert loop.matted is not None
    (target,) = [one for one in loop.matted.facades if one.target]
    (view,) = [one for one in loop.rectified if one.facade == target.index]
    assert np.array_equal(view.quad, shapes.quad(QUAD))
    assert view.method == "drawn by hand"
    for path, ours, kind in ((matte, target, Facade), (rectify, view, Elevation)):
        kept = store.read_table(path.relative_to(other).as_posix()).to_pylist()
        theirs = [row for row in kept if row.get("target") or row.get("quad")]
        (same,) = [r for r in theirs if r["score" if kind is Facade else "aspect"]][:1]
        assert tables.to_row(tables.from_row(kind, same)) == tables.to_row(ours)
    fronts = list({r.front.front_id: r.front for r in rows if r.front}.values())
    every = {"drawn": {name: drawn}}
    oracle = reconstruct.rebuild("5", fronts, photos, networks, **every)
    (block,) = set(artifacts(other, "block")) - glbs
    told = store.read_table(block.relative_to(other).as_posix()).to_pylist()[0]
    assert told["glb"] == oracle.glb


def test_what_was_drawn_is_kept_by_gc(other: Path) -> None:
    write(other)
    built(other)
    before = tree(other)
    assert drop_unkept(Store(str(other)), keep=0).artifacts > 0
    again = built(other)
    assert again.healed == 0
    fresh = {name for name in tree(other) if name.startswith("artifacts/")}
    assert fresh <= before.keys()


def test_it_is_told_what_a_shape_changed(other: Path) -> None:
    (other / "corrections.csv").write_text(f'{HEAD}5_1.png,,,quad,"{QUAD}",by eye\n')
    built(other)
    result = CliRunner().invoke(app, ["corrections", str(other)])
    assert result.exit_code == 0
    told = " ".join(result.output.split())
    assert "quad of 5_1.png: height / width" in told
    assert "corners moved" in told
    assert "the photo from rectify on" in told


def test_before_a_build_it_is_told_that_there_is_none(city: Path) -> None:
    fresh = city.parent / "fresh"
    fresh.mkdir()
    for name in (manifest.CSV, manifest.PARQUET):
        shutil.copy(city / name, fresh / name)
    (fresh / "corrections.csv").write_text(f'{HEAD}5_1.png,,,mask,"{MASK}",\n')
    result = CliRunner().invoke(app, ["corrections", str(fresh)])
    assert "not built yet" in " ".join(result.output.split())


def test_a_photo_in_which_no_front_was_found_is_saved_by_an_outline(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shares, labels, scores, masks = painted.detections()
    unsure = np.where(labels == 1, np.float32(0.01), scores)
    monkeypatch.setattr(painted, "detections", lambda: (shares, labels, unsure, masks))
    city = painted.write_city(tmp_path)
    (city / "corrections.csv").write_text(f'{HEAD}5_1.png,,,mask,"{MASK}",\n')
    report = built(city)
    assert (report.photos, report.rejected_photos) == (4, 3)
    assert report.facades == 1
    names = {one["key"] for one in report.rejections}
    assert names == {"5_2.jpg", "5_2a.png", "6_1.png"}


def test_a_file_that_is_no_photo_stays_one(tmp_path: Path) -> None:
    city = painted.write_city(tmp_path)
    (tmp_path / "photos" / "5_1.png").write_bytes(b"no photo")
    (city / "corrections.csv").write_text(f'{HEAD}5_1.png,,,mask,"{MASK}",\n')
    report = built(city)
    (reason,) = [o["reason"] for o in report.rejections if o["key"] == "5_1.png"]
    assert reason == "not a picture"
