"""The order of fronts on a list without files' names, against its own addresses."""

import csv
from pathlib import Path

import numpy as np
import pytest

from nostalgin_core import scenes
from pipelines.evaluate import orders
from pipelines.index.index import index
from tests.pipelines import painted


@pytest.fixture
def listed(tmp_path: Path) -> Path:
    """Write the list of two painted blocks."""
    rows = scenes.catalogue_rows(
        scenes.neighbourhood(np.random.default_rng(5), blocks=2)
    )
    path = tmp_path / "catalogue.csv"
    with path.open("w", newline="", encoding="utf-8") as file:
        written = csv.DictWriter(file, rows[0])
        written.writeheader()
        written.writerows(rows)
    return path


def test_a_hidden_list_names_no_file_and_keeps_its_blocks_pure(listed: Path) -> None:
    true = orders.read(listed)
    own = {row[orders.BLOCK] for row in true}
    keys = [(min(own), "999"), ("77", "1"), ("77", "2")]
    names, rows = orders.hidden(listed, keys)
    assert orders.FILE not in [name.strip() for name in names]
    assert len(rows) == len(true) + 2
    block, lot = names.index(orders.BLOCK), names.index(orders.LOT)
    assert (min(own), "999") not in {(row[block], row[lot]) for row in rows}


def test_fronts_of_a_sound_list_stand_as_its_addresses_run(
    listed: Path, tmp_path: Path
) -> None:
    (tmp_path / "photos").mkdir()
    (tmp_path / "photos" / "scan.png").write_bytes(painted.photo())
    city = tmp_path / "city"
    index(tmp_path / "photos", listed, str(city))
    report = orders.judged(city, listed)
    assert len(report["blocks"]) == 2
    for one in report["blocks"]:
        assert (one["right"], one["wrong"]) == (one["lots"], ())
    text = "\n".join(orders.lines(report))
    assert text.count(": order right in ") == 2
    assert report["opposite"] == report["streets"]
    report["blocks"][0] |= {"right": 3, "wrong": ("7",), "unnumbered": 2}
    assert "order right in 3 of " in orders.lines(report)[0]
    assert ", not 7; 2 without a number" in orders.lines(report)[0]
