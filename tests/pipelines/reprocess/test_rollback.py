"""A kept run is shown again with the bytes that it had; one that is not, is refused."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from pipelines import reprocess
from pipelines.cli.program import app
from pipelines.store import Store
from pipelines.store.refuse import drop_unkept
from tests.pipelines.cities import artifacts, tree
from tests.pipelines.reprocess import changing
from tests.pipelines.reprocess.test_reprocess import current, redone, site

PLACE = "block,lon,lat\n5,4.9,52.37\n"


def rolled(city: Path, run: str) -> None:
    reprocess.rollback(Store(str(city)), run)


def two_runs(city: Path) -> tuple[str, str]:
    first = current(city)
    changing.add(city, "6_2.png", "6_2.png,6,2,Oak Street,4,7")
    assert redone(city).shown
    return first, current(city)


def test_back_and_forward_give_the_same_bytes(city: Path) -> None:
    old = site(city)
    first, second = two_runs(city)
    new, tables = site(city), tree(city / "runs")
    assert new != old
    rolled(city, first)
    assert (current(city), site(city)) == (first, old)
    assert set(new) <= set(tree(city / "site"))  # who reads it, reads it to its end
    drop_unkept(Store(str(city)), keep=1)  # the one that is shown, and the latest
    rolled(city, second)
    assert (current(city), site(city)) == (second, new)
    assert tree(city / "runs") == tables


def test_what_the_manifest_asks_for_comes_back_with_the_next_run(city: Path) -> None:
    first, _ = two_runs(city)
    new = site(city)
    rolled(city, first)
    assert redone(city).shown
    assert site(city) == new


def test_blocks_lie_where_the_run_was_told(city: Path) -> None:
    (city / "places.csv").write_text(PLACE)
    assert redone(city).shown
    placed, run = site(city), current(city)
    (city / "places.csv").write_text(PLACE.replace("4.9", "5.9"))
    assert redone(city).shown
    assert site(city) != placed
    rolled(city, run)
    assert site(city) == placed


@pytest.mark.parametrize("stage", ["block", "thumbnail"])
def test_a_run_is_refused_whose_artifact_is_gone(city: Path, stage: str) -> None:
    first = current(city)
    mine = artifacts(city, stage)
    changing.change(city, "6_1.png")
    assert redone(city).shown
    for path in mine:
        path.unlink()
    before = tree(city)
    with pytest.raises(reprocess.Unkept, match=f"{stage}.*is gone; restore it"):
        rolled(city, first)
    assert tree(city) == before


def test_a_damaged_model_is_refused_and_the_city_stays(city: Path) -> None:
    first = current(city)
    mine = artifacts(city, "block")
    changing.change(city, "6_1.png")
    assert redone(city).shown
    for path in mine:
        data = bytearray(path.read_bytes())
        data[len(data) // 2] ^= 255
        path.write_bytes(data)
    before = site(city)
    with pytest.raises(reprocess.Unkept, match="restore it"):
        rolled(city, first)
    assert site(city) == before


def test_the_command_names_the_runs_that_are_kept(city: Path) -> None:
    first, second = two_runs(city)
    drop_unkept(Store(str(city)), keep=1)
    asked = ["reprocess", str(city), "--rollback", first]
    refused = CliRunner().invoke(app, asked)
    assert refused.exit_code == 1
    assert f"it keeps: {second}" in " ".join(refused.output.split())
    assert CliRunner().invoke(app, [*asked, "--budget", "2"]).exit_code == 2
    assert CliRunner().invoke(app, [*asked[:3], second]).exit_code == 0
