"""Claims are held against labels: what is right, wrong, or told of nothing."""

import json
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

from pipelines.evaluate import Unmeasurable, fronts
from pipelines.store import Store, runs

RUN = "run"


def square(left: float) -> list[list[float]]:
    return [[left, 10.0], [left + 30, 10.0], [left + 30, 90.0], [left, 90.0]]


def facade(number: int, left: float) -> dict[str, Any]:
    quad = np.array(square(left)).ravel().tolist()
    key = {"photo": "p", "facade": number, "quad_px": quad, "size_px": [120, 100]}
    return {"name": "x_00009_0001.png", **key}


def claim(number: int, lot: str, probability: float = 0.9) -> dict[str, Any]:
    who = {"block": "9", "name": "x_00009_0001.png", "front_id": f"9-{lot}-0"}
    key = {"photo": "p", "facade": number}
    return {**who, **key, "probability": probability, "told": "order"}


@pytest.fixture
def data(tmp_path: Path) -> Path:
    (tmp_path / "photos").mkdir()
    (tmp_path / "labels").mkdir()
    picture = np.zeros((100, 120), np.uint8)
    cv2.imwrite(str(tmp_path / "photos" / "x_00009_0001.png"), picture)
    objects = [{"category": "facade", "polygon": square(x)} for x in (0, 30, 60, 90)]
    label = json.dumps({"objects": objects})
    (tmp_path / "labels" / "00009_0001.json").write_text(label)
    lots = [
        {"object": 0, "lot": "9-1"},
        {"object": 1, "lot": "9-2", "also": ["9-3"]},
        {"object": 2, "lot": "9-4"},
        {"object": 3, "lot": None},
    ]
    (tmp_path / "lots.json").write_text(json.dumps({"00009_0001": lots}))
    return tmp_path


def city(folder: Path, claims: list[dict[str, Any]]) -> Path:
    store = Store(str(folder / "city"))
    seen = [facade(n, x) for n, x in enumerate((2.0, 31.0, 60.0, 89.0))]
    runs.write_table(store, RUN, "facades", seen)
    runs.write_table(store, RUN, "claims", claims)
    store.write_bytes(runs.CURRENT, RUN.encode())
    return folder / "city"


def test_any_lot_under_an_outline_is_right(data: Path) -> None:
    report = fronts.evaluate(data, city(data, [claim(0, "1"), claim(1, "3")]))
    assert report["all"]["right"] == report["all"]["claimed"] == 2
    assert report["all"]["labelled"] == report["all"]["found"] == 3
    assert report["all"]["share claimed"] == pytest.approx(2 / 3)
    assert report["wrong"] == []


def test_a_wrong_claim_is_named_and_so_is_one_of_a_front_that_no_list_has(
    data: Path,
) -> None:
    report = fronts.evaluate(data, city(data, [claim(2, "5", 0.97), claim(3, "6")]))
    assert report["all"]["share right"] == 0.0
    assert [row["is"] for row in report["wrong"]] == [["9-4"], ["none of the list's"]]
    assert "9-5-0" in fronts.text(report)
    claims = {row["above"]: row["claims"] for row in report["stated"]}
    assert claims == {0.8: 0, 0.9: 1, 0.95: 1, 0.99: 0}


def test_a_city_without_claims_is_told(data: Path) -> None:
    with pytest.raises(Unmeasurable, match="build it first"):
        fronts.evaluate(data, data / "nowhere")
