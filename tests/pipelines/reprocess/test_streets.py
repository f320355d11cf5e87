"""A street's width is told of the blocks that it cuts, and of no other."""

from pathlib import Path

from tests.pipelines.cities import built
from tests.pipelines.reprocess.changing import HERE, planned

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
