"""All views of one front are shown, and what each lent is summed up."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from pipelines.build.bench import Bench
from pipelines.build.rows import BorrowedRows, FacadeRows
from pipelines.build.worn import Worn, borrowed
from pipelines.evaluate import Unmeasurable
from pipelines.evaluate import borrowed as measured
from pipelines.explain import Unshown, explain_front
from pipelines.models import Models
from pipelines.store import Store, runs
from tests.core.borrow.test_borrow import (
    CAR,
    OTHER_CAR,
    behind,
    elevation,
    lender,
    wall,
)
from tests.pipelines.build.test_worn import VERSIONS, facade


@pytest.fixture(scope="module")
def city(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A city of one front and three photographs of it, one of another house."""
    folder = tmp_path_factory.mktemp("city")
    store = Store(str(folder))
    own = facade(folder, "own", elevation(wall(1), behind(CAR)))
    first = facade(folder, "first", lender("first", wall(1), OTHER_CAR).view)
    second = facade(folder, "second", lender("second", wall(2), OTHER_CAR).view)
    bench = Bench(store, VERSIONS, Models(str(folder)))
    made = borrowed(Worn(own, "1-1-0", (first, second)), bench)
    told = [row for ref in (own, first, second) for row in FacadeRows(VERSIONS)(ref)]
    runs.write_table(store, "r", "facades", told)
    runs.write_table(store, "r", "borrowed", BorrowedRows(VERSIONS)(made))
    store.write_bytes("CURRENT", b"r\n")
    return folder


def test_every_view_is_drawn_and_every_photograph_told(
    city: Path, tmp_path: Path
) -> None:
    report = explain_front(city, "1-1-0", tmp_path / "out")
    assert report == json.loads((tmp_path / "out" / "front.json").read_text())
    views = {one["photo"]: one for one in report["views"]}
    assert views["first.jpg"]["lent"] > 0
    assert not views["second.jpg"]["fits"]
    assert report["sources"] == ["first.jpg"]
    assert report["left"] < report["unseen"]
    sheet = cv2.imread(str(tmp_path / "out" / "sheet.png"))
    assert sheet is not None
    assert np.ptp(sheet) > 100
    assert len(list((tmp_path / "out").glob("??.png"))) == len(report["pictures"]) == 6


def test_a_front_that_no_wall_wears_is_refused_with_one_that_is(
    city: Path, tmp_path: Path
) -> None:
    with pytest.raises(Unshown, match="as 1-1-0"):
        explain_front(city, "9-9-9", tmp_path)


def test_each_block_s_loans_are_summed_up(city: Path, tmp_path: Path) -> None:
    (one,) = measured.evaluate(city).values()
    assert (one["fronts"], one["lent to"], one["left apart"]) == (1, 1, 1)
    assert one["left"] < 0.1 * one["hidden"]
    assert one["error"] < 0.5
    assert "left apart" in measured.text({"1": one})
    with pytest.raises(Unmeasurable, match="build it again"):
        measured.evaluate(tmp_path)
