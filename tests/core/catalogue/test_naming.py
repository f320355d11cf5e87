"""An archive's own patterns tell block and lot, and no pattern runs away."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nostalgin_core.catalogue import NAMELESS, Naming

FEW = settings(deadline=None, max_examples=50)
OTHER = Naming((r"^lot(?P<lot>\w+)-(?P<borough>[A-Z])(?P<block>\d+)$",))


@FEW
@given(name=st.text())
def test_without_patterns_no_name_tells_anything(name: str) -> None:
    assert NAMELESS.told(name) is None
    assert NAMELESS.guessed(name) is None


@FEW
@given(block=st.integers(1, 99_999), lot=st.integers(1, 9_999))
def test_groups_may_stand_in_any_order(block: int, lot: int) -> None:
    assert OTHER.told(f"b/lot{lot:04}-M{block:05}.jpg") == (str(block), str(lot))


def test_a_lot_need_be_no_number() -> None:
    assert OTHER.told("lot12A-M993.jpg") == ("993", "12A")


def test_the_first_pattern_that_tells_both_is_taken() -> None:
    some = Naming((r"^(?P<block>\d+)(_(?P<lot>\d+))?", r"^(?P<lot>\d+)-(?P<block>\d+)"))
    assert some.told("993_8.jpg") == ("993", "8")
    assert some.told("8-993.jpg") == ("993", "8")


def test_laxer_patterns_are_tried_where_there_is_no_list_alone() -> None:
    lax = Naming((), (r"(?P<block>\d+) lot (?P<lot>\d+)",))
    assert lax.told("993 LOT 8.jpg") is None
    assert lax.guessed("993 LOT 8.jpg") == ("993", "8")


@pytest.mark.parametrize("lot", ["a/b", "x\0", "9" * 5000, "", " "])
def test_what_no_folder_can_be_called_is_no_lot(lot: str) -> None:
    every = Naming((r"^(?P<block>\d+) (?P<lot>(?s:.*))$",))
    told = every.told(f"993 {lot}")
    assert told is None or not set("".join(told)) & set("/\0")


def test_a_pattern_that_would_run_away_takes_time_in_line_with_the_name() -> None:
    # A search that goes back takes 2 ** 20,000 steps, and runs into pytest's limit.
    wild = Naming((r"^(?P<block>(\d+)+)+(?P<lot>(\d|\d\d)+)!$",))
    assert wild.told("1" * 20_000) is None


def test_a_name_in_no_encoding_is_read_as_far_as_it_goes() -> None:
    assert OTHER.told("lot8-M993.jpg") == ("993", "8")
    assert Naming((r"(?P<block>\d+)-(?P<lot>\d+)$",)).told("\udce9 993-8.jpg") == (
        "993",
        "8",
    )
