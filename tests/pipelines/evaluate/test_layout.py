"""A row of known lots: what stands wrong in it is named, and nothing else."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nostalgin_core.city import Move
from nostalgin_core.records import Front
from pipelines.evaluate import Unmeasurable, grounds, layout
from pipelines.evaluate.grounds import Stretch
from pipelines.evaluate.sights import Sights, faced, in_order

OUTLINE = np.array([[0.0, 0.0], [30.0, 0.0], [30.0, 20.0], [0.0, 20.0]])
BLOCK = {
    "block": "9",
    "outlines_m": [OUTLINE.ravel().tolist()],
    "closures_m": [2.5],
}


def lot(
    name: str, west_m: float, east_m: float, deep_m: float = 20.0
) -> dict[str, Any]:
    corners = [[west_m, 0.0], [east_m, 0.0], [east_m, deep_m], [west_m, deep_m]]
    return {
        "block": "9",
        "building_id": f"9-{name}",
        "lot": name,
        "assumed": False,
        "fronts": [f"9-{name}-0"],
        "footprint_m": [value for corner in corners for value in corner],
        "height_m": 12.0,
    }


def front(name: str, rank: int, width_m: float, street: str = "A Street") -> Front:
    return Front(
        front_id=f"9-{name}-0",
        block="9",
        lot=name,
        ring=0,
        side=0,
        rank=rank,
        street=street,
        address="",
        width_m=width_m,
        depth_m=None,
        width_assumed=False,
    )


ROW = [lot("1", 0, 10), lot("2", 10, 20, 8.0), lot("3", 20, 30)]
FRONTS = {f"9-{n}-0": front(n, i, 10.0) for i, n in enumerate("123")}


def told(pairs: dict[tuple[str, str], tuple[str, ...]]) -> dict[str, dict[str, Any]]:
    faces = {f"9-{n}": frozenset({"a street"}) for n in "123"}
    beside = grounds.stretches(ROW, [BLOCK])
    rows = layout.compared(ROW, FRONTS, beside, Sights(faces, pairs), {})
    return {row["building"]: row for row in rows}


def test_a_row_that_stands_as_it_was_seen_has_nothing_wrong() -> None:
    rows = told({("9-1", "9-2"): ("p",), ("9-2", "9-3"): ("p",)})
    for row in rows.values():
        assert (row["street"], row["side"], row["order"], row["width"]) == (True,) * 4
        assert row["beside"] == ""


def test_neighbours_seen_the_other_way_round_are_named_and_the_third_is_not() -> None:
    rows = told({("9-2", "9-1"): ("p7",), ("9-2", "9-3"): ("p",)})
    assert [rows[f"9-{n}"]["order"] for n in "123"] == [False, False, True]
    assert "p7" in rows["9-1"]["beside"]
    assert all(row["side"] for row in rows.values())


def test_who_was_not_seen_beside_another_is_neither_right_nor_wrong() -> None:
    rows = told({("9-1", "9-2"): ("p",), ("9-3", "9-77"): ("p",)})
    assert rows["9-3"]["side"] is None
    assert rows["9-1"]["side"] is True


def test_a_corner_lot_is_beside_its_neighbours_on_either_street() -> None:
    beside = grounds.stretches(ROW, [BLOCK])
    assert [one.side for one in beside["9-1"]] == [0, 2, 3]
    assert [one.side for one in beside["9-2"]] == [0]


def test_a_stretch_runs_from_left_to_right_as_seen_from_the_street() -> None:
    (own,) = grounds.stretches(ROW, [BLOCK])["9-2"]
    assert own.from_m == pytest.approx(10.0, abs=0.1)
    assert own.to_m == pytest.approx(20.0, abs=0.1)
    left, right = Stretch(0, 0, 0.0, 10.0), Stretch(0, 0, 10.0, 20.0)
    assert layout.from_left(left, right)
    assert not layout.from_left(right, left)


def test_what_no_building_closes_is_told_in_metres() -> None:
    (ring,) = grounds.rings(BLOCK, ROW)
    assert ring["before_m"] == 2.5
    assert ring["after_m"] == pytest.approx(10.0, abs=0.2)  # behind lot 2


def test_buildings_that_stand_on_one_another_are_found_in_the_city_plane() -> None:
    other = {**lot("8", 0, 10), "block": "8", "building_id": "8-8"}
    apart = {"9": Move(), "8": Move(0.0, 0.0, -20.0)}
    assert grounds.overlapping([*ROW, other], apart) == []
    near = {"9": Move(), "8": Move(0.0, 5.0, -10.0)}
    found = grounds.overlapping([*ROW, other], near)
    assert [one["buildings"] for one in found] == [["9-1", "8-8"], ["9-2", "8-8"]]
    assert found[0]["area_m2"] == pytest.approx(50.0)


def test_fronts_of_one_street_are_paired_from_left_to_right() -> None:
    drawn = [{"polygon": [[x, 0], [x + 2, 0]]} for x in (40, 10, 70, 90)]
    fronts = [
        {"object": 0, "lot": "9-2", "front": "A", "sure": 2},
        {"object": 1, "lot": "9-1", "front": "A", "sure": 1},
        {"object": 2, "lot": "9-3", "front": "A", "sure": 0},  # a guess
        {"object": 3, "lot": "9-9", "front": "B", "sure": 2},
    ]
    assert in_order(fronts, drawn) == [("9-1", "9-2")]


def test_streets_that_photographs_of_one_lot_show_are_gathered() -> None:
    rows = [
        {"id": "00009_0001", "faces": "A Street; B  Street"},
        {"id": "00009_0001a", "faces": "C Street"},
    ]
    assert faced(rows) == {"9-1": frozenset({"a street", "b street", "c street"})}


def test_a_folder_without_what_was_seen_is_told(tmp_path: Path) -> None:
    (tmp_path / "lots.json").write_text(json.dumps({}))
    with pytest.raises(Unmeasurable, match=r"storeys\.csv"):
        layout.sights(tmp_path)


def test_what_is_wrong_is_written_in_words() -> None:
    rows = list(told({("9-2", "9-1"): ("p7",)}).values())
    rings = grounds.rings(BLOCK, ROW)
    words = layout.text({"lots": rows, "rings": rings, "overlapping": []})
    assert "9-2 left of 9-1 in p7" in words
    assert "missed by 2.5 m" in words
    assert "no two buildings" in words
