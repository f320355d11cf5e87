import json
import subprocess
import sys
from pathlib import Path

import pytest

from pipelines.evaluate import Unmeasurable, slips
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


@needs_data
def test_one_slip_moves_one_lot_of_the_real_list() -> None:
    code = "from pipelines.cli import main; main()"
    words = ["evaluate", "slips", str(DATA / "taxphotos/catalogue.csv"), "--json"]
    run = subprocess.run(
        [sys.executable, "-c", code, *words], capture_output=True, text=True, check=True
    )
    for kinds in json.loads(run.stdout).values():
        for kind, row in kinds.items():
            if kind == "wrong lot":  # no slip of an address: told, not promised
                continue
            assert row["side_kept"] >= 0.99, kind
            assert row["order_kept"] >= 0.99, kind
        assert kinds[slips.ALL]["named"] >= 0.9
