"""A street is one street, however a list shortens its name."""

from dataclasses import replace

import numpy as np
import pytest

from nostalgin_core import catalogue
from nostalgin_core.address import plain_name
from nostalgin_core.catalogue.spelt import spelt

ALIKE = (
    ("East 34th Street", "E. 34 St.", "EAST 34TH STREET", "e 34th st", "East  34 Str."),
    ("Fifth Avenue", "5th Ave", "5 Av.", "FIFTH AVE."),
    ("Hauptstra\u00dfe", "Hauptstr.", "HAUPTSTRASSE"),
    ("Lange Stra\u00dfe", "Lange Str."),
    ("Park Avenue South", "Park Ave. S", "park av south"),
    ("St. Marks Place", "St Marks Pl"),
    ("Avenue A", "Ave. A", "Av A"),
    ("Avenue S", "Ave. S"),
    ("South Street", "SOUTH ST"),
    ("S Street", "S St."),
    ("Ocean Boulevard", "Ocean Blvd."),
    ("West Broadway", "W. Broadway"),
    ("Broadway", "BROADWAY "),
    ("34th Street", "34 St"),
    ("",),
)


@pytest.mark.parametrize("ways", ALIKE)
def test_ways_of_writing_one_street_are_one_name(ways: tuple[str, ...]) -> None:
    assert len({plain_name(way) for way in ways}) == 1


def test_other_streets_are_other_names() -> None:
    assert len({plain_name(ways[0]) for ways in ALIKE}) == len(ALIKE)


def test_a_plain_name_is_plain_already() -> None:
    for way in (way for ways in ALIKE for way in ways):
        assert plain_name(plain_name(way)) == plain_name(way)


def test_a_list_stands_as_one_that_writes_each_street_in_one_way() -> None:
    rng = np.random.default_rng(5)
    rows = [
        {"block": "7", "lot": str(lot), "street": street, "address": str(number)}
        for lot, (street, number) in enumerate(
            [("East 34th Street", number) for number in range(102, 120, 2)]
            + [("Fifth Avenue", number) for number in range(350, 366, 2)],
            1,
        )
    ]
    ways = {own[0]: own for own in ALIKE}
    mixed = [row | {"street": str(rng.choice(ways[row["street"]]))} for row in rows]
    assert len({row["street"] for row in mixed}) > 2
    one, _ = catalogue.fronts(catalogue.read(rows).entries)
    other, doubts = catalogue.fronts(catalogue.read(mixed).entries)
    assert [replace(front, street="") for front in other] == [
        replace(front, street="") for front in one
    ]
    assert len({front.street for front in other}) == 2
    assert any("taken for one" in doubt.text for doubt in doubts)


def test_nothing_is_told_of_streets_that_are_written_in_one_way() -> None:
    row = {"block": "7", "lot": "1", "street": "Fifth Avenue"}
    entries = catalogue.read(
        [row, row | {"lot": "2", "street": "FIFTH AVENUE"}]
    ).entries
    written, doubts = spelt(entries)
    assert not doubts  # large letters are nothing to tell of
    assert len({one.street for one in written}) == 1
