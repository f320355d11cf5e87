import json
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner

from nostalgin_core.segment import CATEGORIES
from pipelines.cli import app
from pipelines.evaluate import Unmeasurable, labels, segmentation, segmentation_table
from tests.outdoors import outdoors

W, H = 320, 256
LEFT = (20, 40, 150, 220)
RIGHT = (150, 60, 260, 220)
FAR = (264, 100, 312, 220)
CAR = (120, 190, 200, 240)
BOARD = (75, 195, 105, 230)  # it tells which front is meant
LEVEL = {LEFT: 120, RIGHT: 165, FAR: 150, CAR: 30, BOARD: 240}

Network = Callable[[np.ndarray], tuple[np.ndarray, ...]]


def _polygon(box: tuple[int, ...]) -> list[list[int]]:
    x0, y0, x1, y1 = box
    return [[x0, y0], [x1 - 1, y0], [x1 - 1, y1 - 1], [x0, y1 - 1]]


def _label(name: str) -> dict:
    return {
        "id": name,
        "objects": [
            {"category": "facade", "polygon": _polygon(LEFT), "target": True},
            {"category": "facade", "polygon": _polygon(RIGHT), "target": False},
            {"category": "facade", "polygon": _polygon(FAR), "group": True},
            {"category": "vehicle", "polygon": _polygon(CAR)},
            {"category": "placard", "polygon": _polygon(BOARD)},
        ],
    }


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two labelled photos of two fronts, a far row and a car before both fronts."""
    home = tmp_path_factory.mktemp("labelled")
    for part in ("photos", "labels"):
        (home / part).mkdir()
    for name, seed in (("00001_0001", 3), ("00002_0001", 4)):
        image = np.full((H, W), 215.0)
        for (x0, y0, x1, y1), level in LEVEL.items():
            image[y0:y1, x0:x1] = level
        image = image + np.random.default_rng(seed).normal(0, 2, image.shape)
        cv2.imwrite(str(home / "photos" / f"x_{name}.png"), image.astype(np.uint8))
        (home / "labels" / f"{name}.json").write_text(json.dumps(_label(name)))
    return home


def _network(*things: tuple[str, tuple[int, ...], float], texels: int = 46) -> Network:
    """Answer every photo with full boxes; masks may have any number of texels."""

    def answer(gray: np.ndarray) -> tuple[np.ndarray, ...]:
        scale = np.array([gray.shape[3] / W, gray.shape[2] / H] * 2)
        boxes = np.array([box for _, box, _ in things], float).reshape(-1, 4) * scale
        names = np.array([CATEGORIES.index(kind) + 1 for kind, _, _ in things])
        scores = np.array([score for _, _, score in things], np.float32)
        masks = np.ones((len(things), texels, texels), np.float32)
        kinds = np.zeros(gray.shape[2:], np.uint8)
        for (kind, _, _), box in zip(things, np.rint(boxes).astype(int), strict=True):
            kinds[box[1] : box[3], box[0] : box[2]] = 1 if kind == "facade" else 2
        planes = [np.where(kinds == kind, 0.98, 0.01) for kind in range(3)]
        pixels = np.stack([*planes, np.zeros(kinds.shape)])[:, 2::4, 2::4]
        answer = boxes.astype(np.float32), names, scores, masks
        return *answer, pixels.astype(np.float32), outdoors(gray)

    return answer


EVERYTHING = (
    ("facade", LEFT, 0.9),
    ("facade", RIGHT, 0.8),
    ("vehicle", CAR, 0.9),
    ("placard", BOARD, 0.9),
)


def test_perfect_answers_are_nearly_perfect_in_every_figure(folder: Path) -> None:
    report = segmentation.evaluate(labels.pairs(folder), _network(*EVERYTHING))
    assert report["photos"] == 2
    assert report["rejected"] == 0
    for kind in ("network", "matted"):
        row = report["table_1"][kind]
        assert row["precision"]["mean"] > 0.97
        assert row["recall"]["mean"] > 0.97
        assert row["l1"]["mean"] < 2
    assert report["targets"] == 2
    assert report["target_overlap_median"] > 0.95
    assert report["target_called"] == 1
    assert report["occluders_found"] > 0.95
    assert report["occluders_false"] < 0.03
    assert report["average_precision"]["vehicle"]["AP75"] == 1
    assert report["average_precision"]["person"]["AP50"] is None


def test_a_front_found_in_a_far_row_is_neither_right_nor_wrong(folder: Path) -> None:
    plain = segmentation.evaluate(labels.pairs(folder), _network(*EVERYTHING))
    report = segmentation.evaluate(
        labels.pairs(folder), _network(*EVERYTHING, ("facade", FAR, 0.95))
    )
    assert report["average_precision"]["facade"] == plain["average_precision"]["facade"]
    for kind in ("network", "matted"):
        found, before = (r["table_1"][kind]["precision"] for r in (report, plain))
        assert found["mean"] == pytest.approx(before["mean"], abs=0.02)


def test_a_missed_front_costs_recall_and_not_precision(folder: Path) -> None:
    report = segmentation.evaluate(
        labels.pairs(folder), _network(EVERYTHING[0], *EVERYTHING[2:])
    )
    row = report["table_1"]["network"]
    assert row["precision"]["mean"] > 0.97
    assert 0.4 < row["recall"]["mean"] < 0.7
    assert report["fronts_found"] == 0.5
    assert report["average_precision"]["facade"]["AP50"] == pytest.approx(51 / 101)


def test_a_photo_that_is_refused_claims_nothing(folder: Path) -> None:
    report = segmentation.evaluate(
        labels.pairs(folder), _network(("facade", LEFT, 0.2))
    )
    assert report["rejected"] == 2
    assert report["table_1"]["matted"]["recall"]["mean"] == 0
    assert report["target_overlap_median"] == 0
    assert report["each"][0]["rejected"] == "no facade found"
    # What the network was unsure of still has its place in the order of scores.
    assert report["average_precision"]["facade"]["AP50"] > 0.4


def test_only_a_block_is_measured_where_one_is_named(folder: Path) -> None:
    report = segmentation.evaluate(
        labels.pairs(folder, block="00002"), _network(*EVERYTHING)
    )
    assert [row["id"] for row in report["each"]] == ["00002_0001"]
    with pytest.raises(Unmeasurable, match="another --block"):
        labels.pairs(folder, block="00003")


def test_a_front_is_told_by_its_size_its_angle_and_what_went_wrong(
    folder: Path, tmp_path: Path
) -> None:
    wide = (LEFT[0], LEFT[1], RIGHT[2], LEFT[3])
    one = segmentation.evaluate(
        labels.pairs(folder),
        _network(("facade", wide, 0.9), *EVERYTHING[2:]),
        sheet=tmp_path,
    )
    told = one["errors"]
    assert (told["fronts"], told["claimed"]) == (4, 2)
    # The wide front overlaps the larger by a half, so that the other is lost in it.
    assert told["merged"] == {"count": 2, "photos": ["00001_0001", "00002_0001"]}
    assert sorted(file.name for file in tmp_path.iterdir()) == ["merged-01.png"]
    page = cv2.imread(str(tmp_path / "merged-01.png"))
    assert page is not None
    assert (page == (40, 40, 255)).all(axis=2).any()  # what is wrong is outlined red
    assert one["facades_by_size"]["above 0.1"]["labelled"] == 4
    assert one["facades_by_size"]["below 0.03"]["AP50"] is None
    assert "taken for one with another front" in segmentation_table.text(one)


def test_an_oblique_front_counts_among_its_angle() -> None:
    tilted = {
        "category": "facade",
        "polygon": _polygon(LEFT),
        "quad": [[20, 40], [80, 90], [80, 170], [20, 220]],
    }
    straight = tilted | {"quad": _polygon(LEFT)}
    label = {"id": "x", "objects": [tilted, straight]}
    views = [one.view_deg for one in labels.truth(label, (H, W)).fronts]
    assert views[0] is not None
    assert views[1] is not None
    assert views[1] < 20
    assert views[0] > 45


def test_what_is_stated_of_targets_is_held_against_the_labels(folder: Path) -> None:
    told = segmentation.evaluate(labels.pairs(folder), _network(*EVERYTHING))
    told = told["target_probability"]
    assert told["photos"] == told["called_rightly"] == told["first_right"] == 2
    assert sum(row["count"] for row in told["bins"]) == 4
    assert told["brier"] < 0.25


def test_the_report_is_json_and_a_table(folder: Path) -> None:
    report = segmentation.evaluate(labels.pairs(folder), _network(*EVERYTHING))
    assert json.loads(json.dumps(report)) == report
    table = segmentation_table.text(report)
    assert "matted > 0.1" in table
    assert "nan" not in table


def test_visible_is_what_nothing_hides() -> None:
    true = labels.truth(_label("x"), (H, W))
    assert not (true.visible & true.hidden).any()
    assert (true.built == (true.visible | (true.hidden & true.built))).all()
    assert not (true.far & true.built).any()
    assert [front.target for front in true.fronts] == [True, False]


@pytest.mark.parametrize(
    ("spoil", "remedy"),
    [
        (lambda home: home / "nowhere", "is no folder"),
        (lambda home: home / "photos", "labels/"),
    ],
)
def test_a_folder_without_labels_is_named_with_the_remedy(
    folder: Path, spoil: Callable[[Path], Path], remedy: str
) -> None:
    wrong = spoil(folder)
    result = CliRunner().invoke(app, ["evaluate", "segmentation", str(wrong)])
    assert result.exit_code == 1
    assert remedy in result.output
    assert wrong.name in result.output
    assert "Traceback" not in result.output


def test_a_label_without_a_photo_or_without_objects_is_named(tmp_path: Path) -> None:
    (tmp_path / "labels").mkdir()
    lonely = tmp_path / "labels" / "a.json"
    lonely.write_text(json.dumps(_label("a")))
    with pytest.raises(Unmeasurable, match="has no photo"):
        labels.pairs(tmp_path)
    lonely.write_text("[]")
    with pytest.raises(Unmeasurable, match="no label"):
        labels.pairs(tmp_path)
