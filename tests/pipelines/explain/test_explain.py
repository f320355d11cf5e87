import json
from pathlib import Path

import cv2
import jsonschema
import numpy as np
import pytest

from nostalgin_core import evidence
from nostalgin_core.steps import Networks
from pipelines.explain.explain import Unreadable, clear, explain, finite, saved
from tests.data import ROOT
from tests.pipelines import painted

SCHEMA = json.loads((ROOT / "pipelines/explain/explain.schema.json").read_text())


@pytest.fixture(scope="module")
def networks(tmp_path_factory: pytest.TempPathFactory) -> Networks:
    return painted.networks(tmp_path_factory.mktemp("models"))


@pytest.fixture(scope="module")
def out(networks: Networks, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One painted photo, explained."""
    folder = tmp_path_factory.mktemp("out")
    explain(painted.photo(1), folder, networks, started=0.0)
    return folder


def told(out: Path) -> dict:
    return json.loads((out / "explain.json").read_text())


def image(out: Path, name: str) -> np.ndarray:
    found = cv2.imread(str(out / name), cv2.IMREAD_UNCHANGED)
    assert found is not None, name
    return found


def test_what_is_written_follows_the_schema(out: Path) -> None:
    jsonschema.validate(told(out), SCHEMA)


def test_the_schema_can_refuse(out: Path) -> None:
    spoiled = told(out)
    del spoiled["facades"][0]["alpha"]
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(spoiled, SCHEMA)


def test_masks_have_the_size_of_the_photo(out: Path) -> None:
    found = told(out)
    size = (found["height"], found["width"])
    assert size == painted.SIZE
    names = [f[kind] for f in found["facades"] for kind in ("mask", "amodal", "alpha")]
    for name in [*names, *(o["mask"] for o in found["occluders"])]:
        assert image(out, name).shape == size
        assert image(out, name).dtype == np.uint8


def test_painted_fronts_are_found_where_they_were_painted(out: Path) -> None:
    found = told(out)
    assert len(found["facades"]) == 2
    for facade, truth in zip(
        found["facades"], (painted.LEFT, painted.RIGHT), strict=True
    ):
        assert np.abs(np.array(facade["quad"]) - truth).max() < 12
    assert [o["category"] for o in found["occluders"]] == ["vehicle"]


def test_elevations_map_back_onto_their_quads(out: Path) -> None:
    for facade in told(out)["facades"]:
        h, w = image(out, facade["elevation"]).shape
        assert image(out, facade["evidence"]).shape == (h, w)
        corners = np.array([[0, 0], [w, 0], [w, h], [0, h]], float)[:, None]
        matrix = np.array(facade["photo_from_elevation"])
        back = cv2.perspectiveTransform(corners - 0.5, matrix)[:, 0]
        assert np.abs(back - np.array(facade["quad"])).max() < 2


def test_what_the_camera_saw_is_left_as_it_was(out: Path) -> None:
    for facade in told(out)["facades"]:
        before, after = image(out, facade["rectified"]), image(out, facade["elevation"])
        seen = image(out, facade["evidence"]) == evidence.PHOTOGRAPHED
        assert seen.any()
        assert np.array_equal(before[seen], after[seen])


def test_a_neighbour_is_inpainted_only_if_it_is_asked_for(
    out: Path, networks: Networks, tmp_path: Path
) -> None:
    explain(painted.photo(1), tmp_path, networks, started=0.0, every=True)
    for facade, whole in zip(
        told(out)["facades"], told(tmp_path)["facades"], strict=True
    ):
        assert whole["inpainted"]
        assert facade["inpainted"] == facade["target"]
        before = image(out, facade["evidence"])
        after = image(tmp_path, whole["evidence"])
        if facade["inpainted"]:
            assert np.array_equal(before, after)
        else:
            assert not np.isin(
                before, (evidence.INPAINTED, evidence.BEYOND_FRAME)
            ).any()


def test_the_stages_stand_side_by_side_in_one_picture(out: Path) -> None:
    picture = image(out, "panel.png")
    assert picture.shape[2] == 3
    assert picture.std() > 20


def test_cpu_seconds_of_the_stages_add_up_to_the_total(out: Path) -> None:
    seconds = told(out)["seconds"]
    stages = sum(spent for stage, spent in seconds.items() if stage != "total")
    assert set(seconds) >= {"segment", "matte", "rectify", "inpaint", "total"}
    assert stages <= seconds["total"] + 0.01
    assert told(out)["peak_rss_bytes"] > 50e6


def test_the_same_photo_is_explained_with_the_same_bytes(
    out: Path, networks: Networks, tmp_path: Path
) -> None:
    explain(painted.photo(1), tmp_path, networks, started=0.0)
    for path in sorted(out.glob("*.png")):
        assert (tmp_path / path.name).read_bytes() == path.read_bytes(), path.name
    changing = ("seconds", "peak_rss_bytes")
    first, second = told(out), told(tmp_path)
    assert {k: v for k, v in first.items() if k not in changing} == {
        k: v for k, v in second.items() if k not in changing
    }


def test_a_photo_without_fronts_is_explained_too(
    networks: Networks, tmp_path: Path
) -> None:
    def blind(gray: np.ndarray) -> tuple[np.ndarray, ...]:
        *things, pixels, rooms = networks.segment(gray)
        return (*(one[:0] for one in things), pixels, rooms)

    found = explain(
        painted.photo(1), tmp_path, Networks(blind, networks.inpaint), started=0.0
    )
    jsonschema.validate(told(tmp_path), SCHEMA)
    assert found["facades"] == []
    assert [one["stage"] for one in found["rejections"]] == ["segment"]
    assert (tmp_path / "panel.png").exists()


def test_a_front_without_lines_is_named_in_its_rejection(
    networks: Networks, tmp_path: Path
) -> None:
    blank = np.full(painted.SIZE, 128, np.uint8)
    data = cv2.imencode(".png", blank)[1].tobytes()
    found = explain(data, tmp_path, networks, started=0.0)
    jsonschema.validate(told(tmp_path), SCHEMA)
    without = [i for i, f in enumerate(found["facades"]) if f["quad"] is None]
    named = [one["facade"] for one in found["rejections"] if "facade" in one]
    assert without == named


@pytest.mark.parametrize("data", [b"", b"no photo", painted.photo(0)[:900]])
def test_what_is_no_photo_is_refused_and_leaves_nothing(
    data: bytes, networks: Networks, tmp_path: Path
) -> None:
    with pytest.raises(Unreadable):
        explain(data, tmp_path / "out", networks, started=0.0)
    assert not (tmp_path / "out").exists()


def test_infinite_numbers_become_null() -> None:
    assert finite({"a": [float("nan"), 1.0, [float("inf")]]}) == {
        "a": [None, 1.0, [None]]
    }


def test_the_schema_travels_with_the_package() -> None:
    shared = ROOT.parent / "shared" / "explain.schema.json"
    if not shared.exists():
        pytest.skip("the contract's original is not here")
    assert json.loads(shared.read_text()) == SCHEMA


def test_a_picture_that_can_not_be_written_is_no_secret(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="gone"):
        saved(tmp_path / "gone", "photo", np.zeros((4, 4), np.uint8))


def test_a_used_folder_holds_the_last_photo_alone_and_what_is_not_ours(
    networks: Networks, out: Path, tmp_path: Path
) -> None:
    used = tmp_path / "used"
    explain(painted.photo(2), used, networks, started=0.0, every=True)
    foreign = {used / "notes.txt", used / "facade_9_mask.png"}
    for path in foreign:
        path.write_text("mine")
    explain(painted.photo(1), used, networks, started=0.0)
    fresh = {path.name for path in out.iterdir()}
    assert {path.name for path in used.iterdir()} == fresh | {p.name for p in foreign}
    assert {path.read_text() for path in foreign} == {"mine"}


def test_a_file_that_names_others_files_takes_none_away(tmp_path: Path) -> None:
    (tmp_path / "kept").mkdir()
    kept = [tmp_path / "kept" / "facade_0_mask.png", tmp_path / "letter.png"]
    for path in kept:
        path.write_bytes(b"x")
    named = '["kept/facade_0_mask.png", "../x.png", "letter.png", "facade_7_mask.png"]'
    (tmp_path / "explain.json").write_text(named)
    clear(tmp_path)
    assert all(path.exists() for path in kept)
