"""A street's width is told of the blocks that it cuts, and of no other."""

from pathlib import Path

from tests.pipelines.cities import built
from tests.pipelines.reprocess import changing
from tests.pipelines.reprocess.changing import HERE, planned
from tests.pipelines.reprocess.test_reprocess import (
    assert_equal_to_a_fresh_build,
    redone,
)

ALONE = ",5-3-0,5,3,0,0,2,Elm Street,5,"
ACROSS = ",5-3-0,5,3,1,0,0,Elm Street,6,"
STREETS = "street,width_m\n"


def two_rings(city: Path) -> None:
    """Let a street cut a block in two."""
    path = city / "manifest.csv"
    text = path.read_text()
    assert ALONE in text
    path.write_text(text.replace(ALONE, ACROSS))
    (city / "streets.csv").write_text(STREETS + "Elm Street,12\n")
    built(city, HERE)
    assert planned(city).nothing


def rows(city: Path, **asked: int) -> int:
    return planned(city, **asked).told()["blocks_by_cause"].get("rows", 0)


def test_a_street_makes_stale_what_it_cuts_alone(city: Path) -> None:
    two_rings(city)
    told = (city / "streets.csv").read_text()
    (city / "streets.csv").write_text(told + "Oak Street,18\n")
    assert rows(city) == 0
    (city / "streets.csv").write_text(told.replace("12", "14"))
    assert rows(city) == 1
    (city / "streets.csv").unlink()
    assert rows(city) == 1


def test_what_waits_alone_is_stale_after_a_budget(city: Path) -> None:
    heights = "building_id,what,value\n6-1,height_m,{0}\n5-1,height_m,{0}\n"
    (city / "corrections.csv").write_text(heights.format(18))
    two_rings(city)
    changing.change(city, "6_1.png")
    changing.change(city, "5_1.png")
    (city / "corrections.csv").write_text(heights.format(21))
    (city / "streets.csv").write_text(STREETS + "Elm Street,14\nOak Street,9\n")
    done = redone(city, budget=1)
    assert (done.plan.photos, done.plan.later) == (1, 1)
    again = planned(city)
    assert (again.photos, again.blocks, rows(city)) == (1, 1, 1)
    assert redone(city, budget=1).shown
    assert planned(city).nothing
    assert_equal_to_a_fresh_build(city, bytes_too=False)
