"""From painted scans without names and a list with decoys to the site, twice."""

import csv
from pathlib import Path

import cv2
import numpy as np
import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

from nostalgin_core import scenes
from nostalgin_core.placard import Key, around
from pipelines.cli import app
from tests.pipelines.cities import tree

SEED = 1940
LOTS = 4  # photographed; all of their block are listed
BLOCK, LOT, FILE = "1940 Block Number", "1940 Lot Number", "File Name "
SAME = ("manifest.", "readings", "warnings.", "site/")


def archive(folder: Path) -> dict[str, Key]:
    """Paint scans with boards under neutral names, and a list that names no file."""
    painted = scenes.neighbourhood(np.random.default_rng(SEED), blocks=1)
    (folder / "photos").mkdir(parents=True)
    truth = {}
    for number, lot in enumerate(painted.blocks[0].lots[:LOTS]):
        rng = np.random.default_rng([SEED, number])
        image = scenes.photograph(painted, lot, rng, view=0).image
        name = f"scan_{number:04}.jpg"
        cv2.imwrite(str(folder / "photos" / name), image)
        truth[name] = (lot.block, lot.lot)
    rows = [row | {FILE: ""} for row in scenes.catalogue_rows(painted)]
    own = {row[BLOCK] for row in rows}
    near = sorted({one for key in truth.values() for one in around(key)})
    decoys = [key for key in near if key[0] not in own][: 10 * len(rows)]
    with (folder / "list.csv").open("w", newline="") as file:
        written = csv.DictWriter(file, rows[0], restval="")
        written.writeheader()
        written.writerows(rows)
        written.writerows({BLOCK: block, LOT: lot} for block, lot in decoys)
    return truth


def nostalgin(*words: object) -> None:
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code in (0, 3), result.output


def city(folder: Path, workers: int) -> Path:
    made = folder / str(workers) / "city"
    beam = ("--direct_num_workers", workers)
    words = ("--catalogue", folder / "list.csv", "-o", made)
    nostalgin("index", folder / "photos", *words, *beam)
    nostalgin("build", made, *beam)
    return made


@pytest.mark.timeout(1800)  # the shipped networks, four runs
def test_scans_without_names_make_the_same_city_with_one_worker_and_two(
    tmp_path: Path,
) -> None:
    truth = archive(tmp_path)
    one, two = (city(tmp_path, workers) for workers in (1, 2))
    table = pq.read_table(one / "readings.parquet").to_pylist()
    put = {row["photo"]: (row["joined_block"], row["joined_lot"]) for row in table}
    joined = {name: key for name, key in put.items() if any(key)}
    assert joined.items() <= truth.items()  # what is not sure is told, and not joined
    assert len(joined) > LOTS / 2
    made, again = (
        {name: sha for name, sha in tree(each).items() if name.startswith(SAME)}
        for each in (one, two)
    )
    assert made == again
    assert {"manifest.parquet", "readings.parquet", "site/tileset.json"} <= set(made)
    assert any(name.startswith("site/blocks/") for name in made)
