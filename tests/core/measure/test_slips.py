from collections.abc import Sequence
from dataclasses import replace

from nostalgin_core import catalogue
from nostalgin_core.catalogue import Entry
from nostalgin_core.measure import slips
from tests.core.painted_lists import SLANTING, WHOLE

FEW = [one for one in WHOLE if int(one.lot) % 3 == 0]


def test_nothing_is_told_of_a_sound_list() -> None:
    assert catalogue.fronts(WHOLE)[1] == ()
    assert catalogue.fronts(SLANTING)[1] == ()


def test_the_street_that_a_slip_hid_is_told() -> None:
    rows = [
        replace(one, street="8 Avenue") if one.lot == "17" else one for one in SLANTING
    ]
    (told,) = catalogue.fronts(rows)[1]
    assert "lot 17 (239-243 8 Avenue)" in told.text
    assert "239-243 West 22 Street" in told.likely


def test_the_number_that_a_swap_hid_is_told() -> None:
    rows = [replace(one, address="271") if one.lot == "19" else one for one in WHOLE]
    (told,) = catalogue.fronts(rows)[1]
    assert "lot 19 (271 West 20 Street)" in told.text
    assert "217 West 20 Street" in told.likely


def test_the_measure_sees_what_moves() -> None:
    def reversed_layout(rows: Sequence[Entry]) -> tuple[Sequence, Sequence[str]]:
        fronts, doubts = catalogue.fronts(rows)
        told = [one.text for one in doubts]
        if len(rows) < len(FEW):  # a row is missing: all is turned about
            last = len(fronts)
            fronts = tuple(replace(one, rank=last - one.rank) for one in fronts)
        return fronts, told

    gone = [
        one for one in slips.outcomes(FEW, reversed_layout) if one.slip.told == "no row"
    ]
    assert all(one.orders_kept < one.fronts / 2 for one in gone)
    assert all(one.sides_kept > 0.9 * one.fronts for one in gone)
