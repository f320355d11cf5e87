import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from pipelines.evaluate import Unmeasurable, views
from tests.core.views.test_views import front

H, W = 420, 300


def photographed(folder: Path, name: str, seeds: list[int]) -> None:
    """Write a photograph of fronts side by side, and its label."""
    for one in ("photos", "labels"):
        (folder / one).mkdir(parents=True, exist_ok=True)
    image = np.hstack([front(seed) for seed in seeds])
    cv2.imwrite(str(folder / "photos" / f"{name}.png"), image)
    objects = []
    for number in range(len(seeds)):
        x0, x1 = number * W, (number + 1) * W - 1
        quad = [[x0, 0], [x1, 0], [x1, H - 1], [x0, H - 1]]
        objects.append({"category": "facade", "polygon": quad, "quad": quad})
    label = {"id": name, "objects": objects}
    (folder / "labels" / f"{name}.json").write_text(json.dumps(label))


def archive(folder: Path) -> Path:
    """Two lots on each of three photographs, each lot on two of them."""
    lots = {}
    for name, seeds in (("9_1", [1, 2]), ("9_2", [2, 3]), ("9_3", [3, 1])):
        photographed(folder, name, seeds)
        lots[name] = [
            {"object": n, "lot": f"9-{seed}", "front": "Elm", "sure": 2}
            for n, seed in enumerate(seeds)
        ]
    (folder / "lots.json").write_text(json.dumps(lots))
    return folder


def test_fronts_that_two_photographs_show_are_told(tmp_path: Path) -> None:
    report = views.evaluate(archive(tmp_path))
    assert report["pairs of one front"] == 3
    assert report["told"]["0.8"]["of one front"] == 1.0
    assert report["corners off, median"] < 0.01
    assert "stated above 0.8" in views.text(report)


def test_without_the_lots_nothing_is_measured(tmp_path: Path) -> None:
    archive(tmp_path)
    (tmp_path / "lots.json").unlink()
    with pytest.raises(Unmeasurable, match=r"lots\.json"):
        views.evaluate(tmp_path)
