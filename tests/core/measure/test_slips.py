from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import pytest

from nostalgin_core import catalogue
from nostalgin_core.catalogue import Entry
from nostalgin_core.measure import slips


def entries(
    block: str, sides: Sequence[tuple[str, Sequence[tuple[int, str]]]]
) -> list[Entry]:
    """List lots with their numbers, street by street, and a photo each."""
    rows = [
        {
            "block": block,
            "lot": str(lot),
            "street": street,
            "address": address,
            "photo": f"rec0040_1_{int(block):05d}_{lot:04d}",
        }
        for street, own in sides
        for lot, address in own
    ]
    return list(catalogue.read(rows).entries)


# A whole block with irregular numbers, ranges, unlisted lots and two later splits.
WHOLE = entries(
    "12",
    [
        ("Broadway", [(1, "700-706")]),
        ("West 20 Street", [(6, "251"), (8, "245-249"), (11, "239"), (12, "233-237")]),
        (
            "West 20 Street",
            [(15, "231"), (16, "221-225"), (19, "217"), (20, "211-215")],
        ),
        ("West 20 Street", [(23, "207"), (124, "201")]),
        ("7 Avenue", [(24, "210"), (25, "212-214"), (27, "216"), (28, "220")]),
        ("West 21 Street", [(30, "202"), (31, "206-208"), (33, "210"), (34, "212")]),
        (
            "West 21 Street",
            [(135, "216"), (36, "218-224"), (40, "228"), (42, "232-240")],
        ),
        ("West 21 Street", [(46, "246"), (47, "250-252")]),
        ("Broadway", [(50, "722"), (52, "712-716")]),
    ],
)
# A block that a slanting street cuts, as Broadway does 993.
SLANTING = entries(
    "13",
    [
        ("8 Avenue", [(1, "401-405"), (3, "407")]),
        ("West 22 Street", [(105, "273"), (5, "269-271"), (6, "265")]),
        ("Bowery", [(8, "1301-1303"), (9, "1305"), (11, "1307-1309")]),
        ("Bowery", [(13, "1302-1304")]),
        ("West 22 Street", [(15, "247"), (17, "239-243"), (19, "233"), (20, "227")]),
        ("6 Avenue", [(23, "801"), (24, "805-807"), (26, "813")]),
        ("West 23 Street", [(30, "228"), (31, "232-236"), (35, "240"), (37, "250")]),
        ("Bowery", [(40, "1322-1326"), (42, "1312-1316")]),
        ("Bowery", [(50, "1313"), (52, "1317-1321")]),
    ],
)
LISTS = {"whole": WHOLE, "slanting": SLANTING}
SEEN = ("other parity", "doubled", "neighbour's photograph", "wrong street")


@cache
def measured(name: str) -> dict[str, list[slips.Outcome]]:
    rows = LISTS[name]
    photos = [row.photo for row in rows]

    def layout(given: Sequence[Entry]) -> tuple[Sequence, Sequence[str]]:
        fronts, told = catalogue.fronts(given)
        _, strangers = catalogue.matched(given, photos)
        return fronts, [*told, *(f"{one.key}: {one.reason}" for one in strangers)]

    kinds = defaultdict(list)
    for outcome in slips.outcomes(rows, layout):
        kinds[outcome.slip.kind].append(outcome)
    return kinds


def share(kept: int, some: Sequence[slips.Outcome]) -> float:
    return kept / sum(one.fronts for one in some)


@pytest.mark.parametrize("name", LISTS)
def test_one_slip_moves_one_lot(name: str) -> None:
    kinds = measured(name)
    assert set(kinds) == set(slips.KINDS)
    for kind in slips.KINDS[:-1]:
        some = kinds[kind]
        assert share(sum(one.sides_kept for one in some), some) >= 0.99, kind
        assert share(sum(one.orders_kept for one in some), some) >= 0.99, kind


@pytest.mark.parametrize("name", LISTS)
def test_slips_that_a_list_shows_are_named_and_few_others(name: str) -> None:
    kinds = measured(name)
    for kind in SEEN:
        assert sum(one.named for one in kinds[kind]) >= 0.9 * len(kinds[kind]), kind
    every = [one for some in kinds.values() for one in some]
    assert sum(one.named for one in every) >= 0.9 * len(every)
    assert sum(len(one.false_alarms) for one in every) <= 0.2 * len(every)


def test_nothing_is_told_of_a_sound_list() -> None:
    assert catalogue.fronts(WHOLE)[1] == ()
    assert catalogue.fronts(SLANTING)[1] == ()


def test_the_street_that_a_slip_hid_is_told() -> None:
    rows = [
        replace(one, street="8 Avenue") if one.lot == "17" else one for one in SLANTING
    ]
    (told,) = catalogue.fronts(rows)[1]
    assert "lot 17 (239-243 8 Avenue)" in told
    assert "239-243 West 22 Street" in told


def test_the_number_that_a_swap_hid_is_told() -> None:
    rows = [replace(one, address="271") if one.lot == "19" else one for one in WHOLE]
    (told,) = catalogue.fronts(rows)[1]
    assert "lot 19 (271 West 20 Street)" in told
    assert "217 West 20 Street" in told


def test_the_measure_sees_what_moves() -> None:
    def reversed_layout(rows: Sequence[Entry]) -> tuple[Sequence, Sequence[str]]:
        fronts, told = catalogue.fronts(rows)
        if len(rows) < len(WHOLE):  # a row is missing: all is turned about
            last = len(fronts)
            fronts = tuple(replace(one, rank=last - one.rank) for one in fronts)
        return fronts, told

    gone = [
        one
        for one in slips.outcomes(WHOLE, reversed_layout)
        if one.slip.told == "no row"
    ]
    assert all(one.orders_kept < one.fronts / 2 for one in gone)
    assert all(one.sides_kept > 0.9 * one.fronts for one in gone)
