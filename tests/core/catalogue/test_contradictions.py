from dataclasses import replace

import pytest

from nostalgin_core.catalogue import catalogue
from nostalgin_core.catalogue.contradictions import contradictions
from nostalgin_core.catalogue.entry import Entry

CELLS = {
    "photo": "rec_00993_0008a.jpg",
    "block": "993",
    "lot": "8",
    "street": "Broadway",
    "address": "1435-1439",
}
(ROW,) = catalogue.read([CELLS]).entries


def told(*rows: Entry) -> list[str]:
    return [one.text for one in contradictions(rows)]


def test_further_views_of_a_lot_contradict_nothing() -> None:
    again = replace(ROW, row=3, photo="rec_00993_0008.jpg")
    plain = replace(ROW, row=4, photo="view.jpg")
    assert told(ROW, again, plain) == []


def test_a_row_that_is_there_twice_is_named() -> None:
    (line,) = told(ROW, replace(ROW, row=7))
    assert "row 2 and row 7 say the same" in line


def test_a_photograph_that_is_by_its_name_another_lot_s_is_named() -> None:
    (line,) = told(replace(ROW, lot="10"))
    assert "lot 10: row 2 names rec_00993_0008a.jpg" in line
    assert "lot 8; mend" in line


@pytest.mark.parametrize(
    ("address", "why"),
    [
        ("1439-1435", "falls"),
        ("1435-1440", "an odd end and an even one"),
        ("1345-1439", "too wide"),
    ],
)
def test_a_range_that_can_t_be_one_lot_s_is_named(address: str, why: str) -> None:
    (line,) = told(replace(ROW, address=address))
    assert f"row 2 says {address}" in line
    assert why in line


@pytest.mark.parametrize("address", ["", "561-565", "108-12", "33 1/2", "1435", "12A"])
def test_ranges_as_archives_write_them_are_sound(address: str) -> None:
    assert told(replace(ROW, address=address)) == []


def along(*addresses: str) -> list[Entry]:
    """A lot for each number of one street, without photographs."""
    return [
        replace(ROW, photo="", row=2 + n, lot=str(20 + n), address=address)
        for n, address in enumerate(addresses)
    ]


def test_a_number_far_from_all_others_of_its_side_is_named() -> None:
    (line,) = told(*along("101", "103-105", "109", "111", "183"))
    assert "lot 24: row 6 says 183, 72 numbers from the next" in line


@pytest.mark.parametrize(
    "addresses",
    [
        ("101", "103", "109", "111", "131"),  # ten doors
        ("101", "103", "131", "133", "183"),  # others stand far apart, too
        ("101", "103", "183"),  # too few to tell
        ("101", "103", "109", "111", "182"),  # the other side's alone
    ],
)
def test_a_number_that_may_well_be_is_not(addresses: tuple[str, ...]) -> None:
    assert told(*along(*addresses)) == []
