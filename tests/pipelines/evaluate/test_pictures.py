"""The lines of three methods on one photo: each votes for what it runs to."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from nostalgin_core.records import Matted
from nostalgin_core.rectify import lines
from pipelines.evaluate import detectors, pictures
from tests.painted_front import photograph

METHODS: dict[str, lines.Detector] = {"ours": lines.detect, "lsd": detectors.lsd}


def test_every_line_votes_for_up_for_its_own_front_or_for_nothing() -> None:
    painted = photograph()
    found = pictures.voted(painted.photo, painted.matted, lines.detect)
    steep = np.abs(np.diff(found.lines[:, [1, 3]], axis=1)[:, 0])
    level = np.abs(np.diff(found.lines[:, [0, 2]], axis=1)[:, 0])
    assert np.all((steep > 2 * level)[found.axis == 0])
    middle = (found.lines[:, :2] + found.lines[:, 2:]) / 2
    for i, facade in enumerate(painted.matted.facades):
        x, y = np.rint(middle[found.axis == i + 1]).astype(int).T
        assert len(x) > 8
        grown = cv2.dilate(facade.amodal.astype(np.uint8), np.ones((9, 9), np.uint8))
        assert np.all(grown[y, x] > 0)
    assert set(found.axis.tolist()) <= {-1, 0, 1, 2}


def test_a_photo_without_a_front_has_no_line_that_speaks() -> None:
    nothing = pictures.voted(photograph().photo, Matted((), ()), lines.detect)
    assert pictures.figures(nothing)["lines"] == 0


def test_figures_count_what_is_drawn() -> None:
    found = pictures.Voted(
        np.array([[0.0, 0, 0, 10], [0, 0, 30, 0], [0, 0, 0, 20], [5, 5, 5, 25]]),
        np.array([0, 2, -1, 0]),
    )
    row = pictures.figures(found)
    assert (row["lines"], row["up_lines"], row["level_lines"]) == (4, 2, 1)
    assert row["median_px"] == 20
    assert row["silent_percent"] == pytest.approx(25.0)
    nothing = pictures.figures(pictures.Voted(np.empty((0, 4)), np.empty(0, np.intp)))
    assert nothing["lines"] == 0
    made = pictures.averaged([{"a": row}, {"a": {**row, "lines": 8}}, {"a": nothing}])
    assert made["a"]["lines"] == 6
    assert made["a"]["photographs"] == 3


def test_a_picture_has_a_panel_for_each_method(tmp_path: Path) -> None:
    painted = photograph()
    file = tmp_path / "deep" / "lines.jpg"
    table = pictures.write(painted.photo, painted.matted, METHODS, file)
    assert list(table) == ["ours", "lsd"]
    picture = cv2.imread(str(file))
    assert picture is not None
    h, w = painted.photo.image.shape
    assert picture.shape[:2] == (h + pictures.TITLE_PX, 2 * w + pictures.GAP)
    red = picture[..., 2].astype(int) - picture[..., 1] > 100
    assert red[:, :w].sum() > 500
    assert red[:, w:].sum() > 500
