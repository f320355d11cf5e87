import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner

from nostalgin_core.measure.labelled_fronts import held_out
from pipelines.cli import app
from pipelines.evaluate import Unmeasurable, inpainting, patchmatch
from pipelines.evaluate.inpainting_questions import asked, kind
from tests.data import DATA, needs_data

FEW = "telea,ours-low-memory"


def believing(_image: np.ndarray, _hole: np.ndarray, guess: np.ndarray) -> tuple:
    """Stand in for a network that adds nothing to the guess."""
    return (guess,)


@pytest.fixture
def images(tmp_path: Path) -> Path:
    """Write three fronts whose windows repeat."""
    y, x = np.mgrid[:96, :80]
    for number, period in enumerate((16, 20, 24)):
        pane = (x % period > period // 2) & (y % 24 > 11)
        image = np.where(pane, np.uint8(60), np.uint8(180))
        cv2.imwrite(str(tmp_path / f"{number}.png"), image)
    return tmp_path


@pytest.fixture
def labelled(tmp_path: Path) -> Path:
    """Write one labelled photograph, with a front and a person before it."""
    for name in ("photos", "labels"):
        (tmp_path / name).mkdir()
    photo = np.full((240, 200), 90, np.uint8)
    photo[:, ::10] = 200
    cv2.imwrite(str(tmp_path / "photos/street.png"), photo)
    quad = [[20, 20], [180, 20], [180, 220], [20, 220]]
    person = [[90, 150], [110, 150], [110, 219], [90, 219]]
    objects = [
        {"category": "facade", "polygon": quad, "quad": quad},
        {"category": "person", "polygon": person},
    ]
    (tmp_path / "labels/street.json").write_text(json.dumps({"objects": objects}))
    return tmp_path


def test_free_form_holes_cover_the_papers_share_and_stay_the_same(images: Path) -> None:
    first, second = (asked(images, holes=("free",)) for _ in range(2))
    assert [one.name for one in first] == ["0.png", "1.png", "2.png"]
    for a, b in zip(first, second, strict=True):
        assert 0.2 <= a.question.hole.mean() <= 0.3
        assert (a.question.hole == b.question.hole).all()
    assert (first[0].question.hole != first[1].question.hole).any()


def test_what_repeats_is_filled_better_than_the_baseline_fills_it(images: Path) -> None:
    report = inpainting.evaluate(images, believing, wanted="repetition")
    rows = report["holes"]["free"]["methods"]
    assert list(rows) == ["navier-stokes", "repetition"]
    assert rows["navier-stokes"]["l1_of_baseline"] == 1
    assert rows["repetition"]["l1_of_baseline"] < 0.5


def test_a_labelled_folder_asks_about_its_front_and_never_about_the_person(
    labelled: Path,
) -> None:
    questions = asked(labelled)
    assert [one.holes for one in questions] == ["free", "foot"]
    for one in questions:
        assert one.question.image.shape == (200, 160)
        assert one.question.hole[150:195, 72:88].all()
        assert not one.question.scored[150:195, 72:88].any()
    foot = questions[1].question
    assert foot.hole[-1].any()
    assert not foot.hole[:20].any()


def test_a_truth_that_is_changed_inside_the_hole_changes_no_fill(images: Path) -> None:
    seen = []

    def look(image: np.ndarray, hole: np.ndarray) -> np.ndarray:
        seen.append(image[hole])
        return image

    inpainting._scores(look, asked(images, holes=("free",)))
    assert len(seen) == 3
    assert all((values == 0).all() for values in seen)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nowhere"], "is no folder"),
        ([".", "--holes", "foot"], "no labelled people"),
        ([".", "--holes", "square"], "choose from free, foot"),
        ([".", "--methods", "magic"], "choose from navier-stokes"),
    ],
)
def test_what_cannot_be_measured_is_told_with_a_remedy(
    images: Path, arguments: list[str], message: str
) -> None:
    folder, *options = arguments
    command = ["evaluate", "inpainting", str(images / folder), *options]
    result = CliRunner().invoke(app, command)
    assert result.exit_code == 1
    assert message in result.output


def test_an_empty_folder_and_a_broken_image_are_named(tmp_path: Path) -> None:
    with pytest.raises(Unmeasurable, match="no picture to ask about"):
        asked(tmp_path, holes=("free",))
    (tmp_path / "torn.png").write_bytes(b"not a picture")
    with pytest.raises(Unmeasurable, match=r"torn\.png"):
        asked(tmp_path, holes=("free",))


def test_the_command_prints_a_table_or_json(images: Path) -> None:
    command = ["evaluate", "inpainting", str(images), "--most", "1", "--methods", FEW]
    shown = CliRunner().invoke(app, command)
    assert shown.exit_code == 0
    assert "l1/NS" in shown.output
    report = json.loads(CliRunner().invoke(app, [*command, "--json"]).output)
    part = report["holes"]["free"]
    assert part["questions"] == 1
    assert set(part["methods"]) == {"navier-stokes", *FEW.split(",")}


def test_patchmatch_names_its_library_where_it_is_missing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(patchmatch, "available", lambda: False)
    with pytest.raises(Unmeasurable, match="pip install nostalgin"):
        patchmatch.patchmatch(np.zeros((9, 9), np.uint8), np.ones((9, 9), bool))


@needs_data
def test_the_projects_own_data_asks_about_fronts_that_no_training_saw() -> None:
    assert kind(DATA) == "held-out fronts"
    for one in asked(DATA, holes=("free",), most=3):
        folder, stem, _ = one.name.split("/")
        assert held_out(folder, stem)
