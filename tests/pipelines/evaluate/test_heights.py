from pathlib import Path
from typing import Any

import pytest

from pipelines.evaluate import Unmeasurable, heights
from pipelines.store import Store, runs

COUNTS = """id,storeys,cut,blank,bays,kind,faces,sure,note
00001_0001,5,0,0,3,shop,A Street,2,
00001_0001a,5,0,0,3,shop,A Street,2,
00001_0002,4,0,0,3,shop,A Street,2,
00001_0003,4,0,1,0,theatre,A Street,1,blank wall
00001_0004,16,0,0,0,tower,A Street,1,counted to first setback
00001_0005,6,0,0,0,hotel,A Street,0,
"""


def building(lot: str, height_m: float, low_m: float, high_m: float) -> dict[str, Any]:
    return {
        "block": "1",
        "building_id": f"1-{lot}",
        "lot": lot,
        "height_m": height_m,
        "height_low_m": low_m,
        "height_high_m": high_m,
        "height_by_storeys_m": height_m,
        "height_supported": True,
        "height_contradicted_by": ["width"] if lot == "2" else [],
    }


@pytest.fixture
def measured(tmp_path: Path) -> dict[str, Any]:
    (tmp_path / "storeys.csv").write_text(COUNTS)
    store = Store(str(tmp_path / "city"))
    built = [
        building("1", 19.0, 15.0, 22.0),
        building("2", 30.0, 24.0, 40.0),
        building("3", 15.0, 10.0, 20.0),
        building("4", 20.0, 10.0, 70.0),
        building("9", 20.0, 10.0, 70.0),  # nobody counted it
    ]
    runs.write_table(store, "r", "buildings", built)
    store.write_bytes(runs.CURRENT, b"r")
    return heights.evaluate(tmp_path, tmp_path / "city")


def test_heights_near_and_intervals_that_hold_are_counted(
    measured: dict[str, Any],
) -> None:
    assert measured[heights.COUNTED] == {
        "lots": 2,
        "near": 1,
        "held": 1,
        "supported": 2,
        "contradicted": 1,
    }
    assert measured[heights.BLANK]["lots"] == 1
    assert measured[heights.NONE] == 1


def test_a_wrong_height_is_named(measured: dict[str, Any]) -> None:
    told = heights.text(measured)
    assert "1-2 " in told
    assert "1-1 " not in told
    assert "1-4 " not in told


def test_a_folder_without_a_city_is_told(tmp_path: Path) -> None:
    (tmp_path / "storeys.csv").write_text(COUNTS)
    with pytest.raises(Unmeasurable, match="build it first"):
        heights.evaluate(tmp_path, tmp_path)


def test_a_row_without_a_count_is_named(tmp_path: Path) -> None:
    (tmp_path / "storeys.csv").write_text(COUNTS.replace("_0002,4", "_0002,four"))
    with pytest.raises(Unmeasurable, match="row 4"):
        heights.counted(tmp_path / "storeys.csv")
