"""What `nostalgin evaluate rectification` prints: laws of each part's figures."""

import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner

from nostalgin_core.measure import rectification
from nostalgin_core.records import Box, Photo, Rejection
from nostalgin_core.rectify import camera, lines, manhattan
from pipelines import cli
from pipelines.evaluate import (
    label_points,
    labelled,
    peers,
    rectification_table,
    search_space,
    sheet,
    sphere,
    york_urban,
)
from tests.data import DATA
from tests.painted_front import photograph

CAMERA = camera.matrix(680.0, Box(0, 0, 640, 480))


def labelled_folder(folder: Path) -> Path:
    """Photograph a painted corner and label it by its truth, with a group beside."""
    painted = photograph(seed=2)
    for part in ("photos", "labels"):
        (folder / part).mkdir(parents=True)
    cv2.imwrite(str(folder / "photos" / "corner.jpg"), painted.photo.image)
    fronts = [
        {
            "category": "facade",
            "polygon": quad.tolist(),
            "quad": quad.tolist(),
            "target": i == 0,
            "group": False,
            "complete": True,
        }
        for i, quad in enumerate(painted.quads)
    ]
    group = {"category": "facade", "polygon": [[0, 0], [30, 0], [0, 99]], "group": True}
    label = {"id": "corner", "objects": [*fronts, group]}
    (folder / "labels" / "corner.json").write_text(json.dumps(label))
    return folder


def test_a_label_becomes_masks_without_occluders_and_groups() -> None:
    square = [[10, 10], [50, 10], [50, 90], [10, 90]]
    label = {
        "objects": [
            {"category": "facade", "polygon": square, "target": True},
            {"category": "facade", "polygon": square, "group": True},
            {"category": "vehicle", "polygon": [[0, 70], [60, 70], [60, 95], [0, 95]]},
        ]
    }
    image = Photo("0" * 16, np.zeros((100, 80), np.uint8), Box(0, 0, 80, 100))
    fronts, matted = labelled.matted_from(label, image)
    assert len(fronts) == len(matted.facades) == 1
    (facade,) = matted.facades
    assert facade.target
    assert facade.amodal[80, 30]
    assert not facade.alpha[80, 30]
    assert facade.alpha[40, 30] == 1
    assert [one.category for one in matted.occluders] == ["vehicle"]


def test_true_labels_are_nearly_rectangles_and_groups_are_never_scored(
    tmp_path: Path,
) -> None:
    row = labelled.summed(list(labelled.straightened(labelled_folder(tmp_path))))
    assert (row["target_fronts"], row["all_fronts"]) == (1, 2)
    assert (row["target_straightened"], row["all_straightened"]) == (1, 2)
    assert 0 <= row["all_angle_median"] <= row["all_angle_p90"] < 0.7
    assert row["rejections"] == {}


def test_a_spoiled_label_errs_by_what_it_was_spoiled(tmp_path: Path) -> None:
    folder = labelled_folder(tmp_path)
    file = folder / "labels" / "corner.json"
    label = json.loads(file.read_text())
    quad = np.array(label["objects"][0]["quad"])
    width = np.linalg.norm(quad[1] - quad[0])
    quad[1, 1] += width * np.tan(np.radians(8))
    label["objects"][0]["quad"] = quad.tolist()
    file.write_text(json.dumps(label))
    row = labelled.summed(list(labelled.straightened(folder)))
    assert 5 < row["target_angle_median"] < 12


def test_true_labels_lie_within_what_is_stated(tmp_path: Path) -> None:
    photographs = list(labelled.straightened(labelled_folder(tmp_path)))
    residuals = label_points.compared(photographs[0])
    assert [one.quantity for one in residuals] == ["horizontal", "vertical"] * 2
    assert all(one.error < 1.96 * one.sd for one in residuals)
    table = label_points.coverage(photographs)
    assert table["vertical"]["all"]["count"] == 2
    assert table["vertical"]["all"]["share"] == 1


def test_a_labels_noise_moves_its_points_by_what_is_foretold() -> None:
    quad = np.array([[150.0, 120.0], [420.0, 60.0], [430.0, 420.0], [140.0, 400.0]])
    rng = np.random.default_rng(0)
    per_axis = label_points.LABEL_SD_PX / np.sqrt(2)
    for rank in range(2):
        true = label_points.points(quad)[rank]
        turns = [
            rectification.angle_deg(
                label_points.points(quad + rng.normal(0, per_axis, (4, 2)))[rank],
                true,
                CAMERA,
            )
            for _ in range(800)
        ]
        foretold = label_points.label_sd_deg(quad, rank, CAMERA)
        assert foretold == pytest.approx(np.sqrt(np.mean(np.square(turns))), rel=0.1)


def turned_deg(angle: float) -> manhattan.Manhattan:
    """Find the true directions with the camera turned about its own axis."""
    cosine, sine = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    turn = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
    return manhattan.Manhattan((turn @ np.eye(3)[[1, 0, 2]].T).T @ CAMERA.T, 680.0)


@pytest.mark.parametrize("angle", [0.0, 1.0])
def test_a_camera_turned_by_an_angle_errs_by_it(angle: float) -> None:
    view = york_urban.View(np.zeros((480, 640), np.uint8), np.eye(3))
    row = york_urban.measured(lambda _: turned_deg(angle), [view], CAMERA)
    assert row["median_deg"] == pytest.approx(angle, abs=1e-5)
    assert row["mean_deg"] == pytest.approx(2 * angle / 3, abs=1e-5)
    assert row["focal_error_percent"] == pytest.approx(0, abs=1e-9)
    # the horizon turns about the image's middle: it is off by tan(angle) w / 2 at most
    off = np.tan(np.radians(angle)) * 320 / 480
    assert row["horizon_auc"] == pytest.approx(100 * (1 - off / 0.25), abs=0.01)


def test_a_finder_that_finds_nothing_errs_by_right_angles() -> None:
    view = york_urban.View(np.zeros((480, 640), np.uint8), np.eye(3))
    row = york_urban.measured(lambda _: None, [view], CAMERA)
    assert row["median_deg"] == row["mean_deg"] == 90
    assert row["horizon_auc"] == 0


@pytest.mark.skipif(not peers.installed(), reason="lu_vp_detect is not installed")
def test_the_peer_finds_a_painted_corners_directions() -> None:
    painted = photograph()
    h, w = painted.photo.image.shape
    matrix = camera.matrix(painted.focal_px, Box(0, 0, w, h))
    found = peers.lu_vp_detect(painted.photo.image, focal_px=painted.focal_px)
    assert found is not None
    rays = np.linalg.solve(matrix, found.vanishing_points.T).T
    rays = rays / np.linalg.norm(rays, axis=1, keepdims=True)
    assert abs(rays[0, 1]) > 0.9  # up comes first
    assert np.abs(rays @ rays.T - np.eye(3)).max() < 0.01
    across = painted.quads[0][1] - painted.quads[0][0]
    middle = painted.quads[0][:2].mean(axis=0)
    to_points = found.vanishing_points[:, :2] - found.vanishing_points[:, 2:] * middle
    cosines = np.abs(to_points @ across) / np.linalg.norm(to_points, axis=1)
    assert cosines.max() / np.linalg.norm(across) > np.cos(np.radians(2))
    blank = np.full((60, 60), 90, np.uint8)
    assert peers.lu_vp_detect(blank, focal_px=60.0) is None


def test_deduplication_shrinks_the_search() -> None:
    found = search_space.reductions(photograph().photo.image)
    assert found["both"][0] >= max(found["collinear lines"][0] - 1e-9, 1)
    assert found["infinite points"][0] >= 0
    assert all(moved < 2 for _, _, moved, _ in found.values())
    assert all(settled < 0.1 for *_, settled in found.values())


def test_refining_finds_where_lines_meet_and_keeps_it() -> None:
    rng = np.random.default_rng(1)
    true = np.array([2.0, -0.3, 1.0]) / np.linalg.norm([2.0, -0.3, 1.0])
    start = rng.uniform(-0.5, 0.5, (40, 2))
    end = start + 0.2 * (true[:2] / true[2] - start)
    near = true + np.array([0.0, 0.01, 0.0])
    drawn = np.hstack([start, end])
    found = sphere.refined(near / np.linalg.norm(near), drawn, np.ones(40))
    assert search_space.apart_deg(found, true) < 1e-6


def test_photographs_are_chosen_evenly(tmp_path: Path) -> None:
    for i in range(40):
        (tmp_path / f"{i:02d}.jpg").touch()
    names = [file.stem for file in search_space.chosen(tmp_path, most=6)]
    assert names == ["00", "07", "14", "21", "28", "35"]
    with pytest.raises(ValueError, match="jpg"):
        search_space.chosen(tmp_path / "empty")


def test_table_2_sums_up_and_stands_beside_the_papers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(search_space, "SHORT_SIDE_PX", 450)
    folder = labelled_folder(tmp_path / "taxphotos")
    table = search_space.evaluate(folder / "photos")
    assert table["photographs"] == 1
    assert table["both"]["space_percent_sd"] == 0
    text = "\n".join(rectification_table.table_2({"taxphotos": table}))
    assert "taxphotos, 1 photos" in text
    assert "44.3 +- 18.7" in text


@pytest.mark.skipif(
    not (DATA / "york_urban").is_dir(), reason=f"no York Urban images at {DATA}"
)
def test_two_images_of_york_urban_are_evaluated(tmp_path: Path) -> None:
    for name in ("cameraParameters.mat", "P1030001", "P1080032"):
        (tmp_path / name).symlink_to(DATA / "york_urban" / name)
    row = york_urban.evaluate(tmp_path, {"ours": lines.detect})["ours"]
    assert row["images"] == 2
    assert row["median_deg"] < 3
    assert 50 < row["horizon_auc"] <= 100


def test_a_contact_sheet_shows_every_photograph_with_both_quads(tmp_path: Path) -> None:
    folder = labelled_folder(tmp_path / "taxphotos")
    (one,) = labelled.straightened(folder)
    files = sheet.write([one] * 5, tmp_path / "pages")
    assert [file.name for file in files] == ["page-01.jpg", "page-02.jpg"]
    page = cv2.imread(str(files[0]))
    assert page is not None
    h, w = sheet.CELL
    first, second = page[:h, :w], page[:h, w : 2 * w]
    assert np.abs(first.astype(int) - second).mean() < 1  # the same photo, twice
    drawn = sheet.quads(one).astype(int)
    green = (drawn[..., 1] - drawn[..., 2] > 80).sum()
    yellow = (drawn[..., 2] - drawn[..., 0] > 80).sum()
    assert green > 200  # the target's quad
    assert yellow > 200  # its neighbour's
    refused = replace(
        one, results=(Rejection("0" * 16, "rectify", "too few lines"),) * 2
    )
    drawn = sheet.quads(refused).astype(int)
    assert (drawn[..., 2] - drawn[..., 1] > 80).sum() > 400


def said(*arguments: str) -> tuple[int, str]:
    """Run the command."""
    result = CliRunner().invoke(cli.app, ["evaluate", "rectification", *arguments])
    return result.exit_code, result.output


def test_labels_are_measured_on_the_command_line(tmp_path: Path) -> None:
    labelled_folder(tmp_path / "taxphotos")
    code, table = said(str(tmp_path), "--parts", "labels")
    assert code == 0
    assert "taxphotos, ours, target" in table
    code, output = said(str(tmp_path), "--parts", "labels", "--json")
    report = json.loads(output)
    assert report["labels"]["taxphotos"]["ours"]["all_fronts"] == 2
    assert rectification_table.text(report).splitlines()[:2] == table.splitlines()[:2]


def test_a_folder_without_data_is_named_and_ends_with_one(tmp_path: Path) -> None:
    for folder in (tmp_path, tmp_path / "nowhere"):
        code, output = said(str(folder))
        assert code == 1
        assert str(folder) in output
    (tmp_path / "taxphotos" / "labels").mkdir(parents=True)
    code, output = said(str(tmp_path), "--parts", "york_urban")
    assert code == 1
    assert "york_urban/" in output
    code, output = said(str(tmp_path), "--parts", "labels", "--block", "00777")
    assert code == 1
    assert "00777*.json" in output
    code, output = said(str(tmp_path), "--parts", "label")
    assert code == 1
    assert "there are york_urban, labels, painted, table2" in output


def test_painted_streets_need_no_data_and_a_part_of_no_name_lists_the_parts(
    tmp_path: Path,
) -> None:
    asked = ["evaluate", "rectification", str(tmp_path), "--fronts", "1", "--parts"]
    done = CliRunner().invoke(cli.app, [*asked, "painted"])
    assert done.exit_code == 0, done.output
    assert "worst angle" in done.output
    wrong = CliRunner().invoke(cli.app, [*asked, "paint"])
    assert wrong.exit_code == 1
    assert "painted" in wrong.output
