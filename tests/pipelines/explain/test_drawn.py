"""A photo explained with its city's corrections."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner, Result

from nostalgin_core.steps import photograph
from pipelines.cli import app
from pipelines.corrections import shapes
from pipelines.explain import redrawn
from pipelines.models import Models
from tests.pipelines import painted

HEAD = "photo,front_id,building_id,what,value,note\n"
MASK = "45,90 265,145 268,555 44,590"
QUAD = "50,95 260,150 262,550 48,585"
ROWS = f'5_1.png,,,mask,"{MASK}",\n5_1.png,,,quad,"{QUAD}",\n'


@pytest.fixture
def photo(tmp_path: Path) -> Path:
    made = {"segment": painted.segment_network(), "inpaint": painted.inpaint_network()}
    painted.write_models(tmp_path / "models", **made)
    path = tmp_path / "a" / "5_1.png"
    path.parent.mkdir()
    path.write_bytes(painted.photo(1))
    return path


def explained(photo: Path, rows: str, *words: str) -> Result:
    folder = photo.parent.parent
    (folder / "corrections.csv").write_text(HEAD + rows)
    asked = ["explain", photo, "-o", folder / "out", "--models", folder / "models"]
    asked += ["--no-placard", "--corrections", folder / "corrections.csv", *words]
    return CliRunner().invoke(app, [str(word) for word in asked])


def target(photo: Path) -> dict:
    report = json.loads((photo.parent.parent / "out" / "explain.json").read_text())
    (one,) = [facade for facade in report["facades"] if facade["target"]]
    return one


def test_what_is_drawn_is_taken_as_a_build_takes_it(photo: Path) -> None:
    result = explained(photo, ROWS)
    assert result.exit_code == 0, result.output
    assert result.output.count("is taken as it is drawn") == 2
    shown, folder = target(photo), photo.parent.parent
    found = redrawn(photo, photo.read_bytes(), folder / "corrections.csv")
    networks = Models(str(folder / "models")).networks(placard=False)
    made = photograph(photo.read_bytes(), networks, name="x", drawn=found.drawn)
    assert made.matted is not None
    (facade,) = [one for one in made.matted.facades if one.target]
    (view,) = [one for one in made.elevations if one.facade == facade.index]
    assert np.allclose(shown["quad"], view.quad)
    assert np.abs(np.array(shown["quad"]) - shapes.quad(QUAD)).max() < 0.5
    amodal = cv2.imread(str(folder / "out" / shown["amodal"]), 0)
    assert amodal is not None
    assert np.array_equal(amodal > 0, facade.amodal)


def test_without_rows_of_the_photo_nothing_changes_and_that_is_told(
    photo: Path,
) -> None:
    result = explained(photo, ROWS.replace("5_1.png", "b/5_1.png"))
    assert result.exit_code == 0
    assert "says nothing of 5_1.png" in result.output
    before = target(photo)
    assert (
        CliRunner()
        .invoke(
            app,
            [str(w) for w in ("explain", photo, "-o", photo.parent.parent / "out")]
            + ["--no-placard", "--models", str(photo.parent.parent / "models")],
        )
        .exit_code
        == 0
    )
    assert target(photo) == before


def test_a_row_names_the_photo_as_the_manifest_does(photo: Path) -> None:
    result = explained(photo, ROWS.replace("5_1.png", "a/5_1.png"))
    assert result.output.count("is taken as it is drawn") == 2


def test_what_is_of_blocks_is_told(photo: Path) -> None:
    result = explained(photo, "5_1.png,,,key,5-2,\n5_1.png,,,target,400,\n")
    assert result.exit_code == 0
    assert result.output.count("is of its block: nothing changes here") == 2


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ('5_1.png,,,mask,"0,0 9000,0 9000,9000 0,9000",\n', "leaves its photo"),
        ('5_1.png,,,quad,"1,1 2,2",\n', "has 2 corners"),
    ],
)
def test_a_shape_that_is_none_is_refused_and_ends_with_3(
    row: str, said: str, photo: Path
) -> None:
    result = explained(photo, row)
    assert result.exit_code == 3
    assert said in " ".join(result.output.split())
    assert (photo.parent.parent / "out" / "panel.png").is_file()


def test_a_file_that_is_not_there_is_named(photo: Path) -> None:
    result = explained(photo, "", "--corrections", "nowhere.csv")
    assert result.exit_code == 1
    assert "nowhere.csv" in result.output
