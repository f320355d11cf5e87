import csv
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from nostalgin_core.catalogue import Entry
from pipelines.evaluate import Unmeasurable, slips
from tests.core.painted_lists import SLANTING, WHOLE
from tests.data import DATA, needs_data

LIST = """photo,block,lot,street,address
a_00007_0001.jpg,7,1,Elm Street,101
a_00007_0002.jpg,7,2,Elm Street,105
a_00007_0003.jpg,7,3,Elm Street,109
a_00007_0004.jpg,7,4,Oak Street,2
a_00007_0005.jpg,7,5,Oak Street,6
"""


def test_every_kind_of_slip_is_counted_and_told(tmp_path: Path) -> None:
    (tmp_path / "list.csv").write_text(LIST)
    report = slips.evaluate(tmp_path / "list.csv")
    assert set(report["7"]) == {*slips.slips.KINDS, slips.ALL}
    assert report["7"][slips.ALL]["side_kept"] >= 0.99
    assert "neighbour's photograph" in slips.text(report)


def test_a_list_without_lots_is_named(tmp_path: Path) -> None:
    (tmp_path / "list.csv").write_text("photo,block,lot\n")
    with pytest.raises(Unmeasurable, match=r"list\.csv lists no lot"):
        slips.evaluate(tmp_path / "list.csv")


def told(path: Path) -> dict[str, dict[str, Any]]:
    """Run the command by itself: types are not checked there, for the time it takes."""
    code = "from pipelines.cli import main; main()"
    run = subprocess.run(
        [sys.executable, "-c", code, "evaluate", "slips", str(path), "--json"],
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(run.stdout)


def hold_the_law(kinds: dict[str, Any]) -> None:
    for kind, row in kinds.items():
        if kind not in {"wrong lot", slips.ALL}:  # no slip of an address is that
            assert row["side_kept"] >= 0.99, kind
            assert row["order_kept"] >= 0.99, kind
    assert kinds[slips.ALL]["named"] >= 0.9


@pytest.mark.parametrize("entries", [WHOLE, SLANTING], ids=["whole", "slanting"])
def test_one_slip_moves_one_lot_and_is_named(
    entries: list[Entry], tmp_path: Path
) -> None:
    names = ("photo", "block", "lot", "street", "address")
    with (tmp_path / "list.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(names)
        writer.writerows([getattr(one, name) for name in names] for one in entries)
    (kinds,) = told(tmp_path / "list.csv").values()
    hold_the_law(kinds)
    for kind in ("doubled", "neighbour's photograph"):
        assert kinds[kind]["named"] == 1.0
    assert kinds[slips.ALL]["false_alarms"] <= 0.2


@needs_data
def test_one_slip_moves_one_lot_of_the_real_list() -> None:
    for kinds in told(DATA / "taxphotos/catalogue.csv").values():
        hold_the_law(kinds)
