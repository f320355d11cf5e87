import csv
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from nostalgin_core.block import block
from nostalgin_core.catalogue import catalogue, rings
from nostalgin_core.catalogue.directions import directions
from nostalgin_core.catalogue.entry import Entry
from nostalgin_core.records import Front
from tests.core.painted_lists import WHOLE
from tests.data import DATA, needs_data


def entries(*rows: tuple[str, str, str], block: str = "9") -> list[Entry]:
    """Make entries of lot, street and address."""
    cells = [
        {"block": block, "lot": lot, "street": street, "address": address}
        for lot, street, address in rows
    ]
    return list(catalogue.read(cells).entries)


def laid_out(
    rows: Sequence[Entry],
) -> tuple[tuple[Front, ...], tuple[str, ...]]:
    """Order fronts, and tell what is doubtful in words."""
    fronts, doubts = rings.fronts(rows)
    return fronts, tuple(one.text for one in doubts)


def walk(fronts: tuple[Front, ...], ring: int = 0) -> list[str]:
    """List the lots of a ring as one walks round it."""
    return [one.lot for one in fronts if one.ring == ring]


# An ordinary block of the numbered grid: lots run anticlockwise from the south-west.
PLAIN = entries(
    ("1", "West 10 Street", "139"),
    ("2", "West 10 Street", "137"),
    ("3", "West 10 Street", "131-135"),
    ("5", "Sixth Avenue", "201"),
    ("6", "Sixth Avenue", "203"),
    ("8", "West 11 Street", "130"),
    ("9", "West 11 Street", "134"),
    ("10", "West 11 Street", "136-140"),
    ("12", "Seventh Avenue", "64"),
    ("14", "Seventh Avenue", "60"),
)


def test_an_ordinary_block_comes_out_in_the_order_of_its_lots() -> None:
    fronts, warnings = laid_out(PLAIN)
    assert walk(fronts) == ["1", "2", "3", "5", "6", "8", "9", "10", "12", "14"]
    assert [one.side for one in fronts] == [0, 0, 0, 1, 1, 2, 2, 2, 3, 3]
    assert not warnings


def test_the_order_of_rows_does_not_matter() -> None:
    rng = np.random.default_rng(0)
    shuffled = [PLAIN[place] for place in rng.permutation(len(PLAIN))]
    assert laid_out(shuffled) == laid_out(PLAIN)


def test_several_rows_of_one_lot_are_one_front() -> None:
    again = entries(("3", "West 10 Street", "131-135"), ("3", "West 10 Street", ""))
    assert laid_out([*PLAIN, *again])[0] == laid_out(PLAIN)[0]


def test_a_lot_on_two_streets_has_two_fronts() -> None:
    corner = entries(("3", "Sixth Avenue", "199"))
    fronts, _ = laid_out([*PLAIN, *corner])
    ids = [one.front_id for one in fronts if one.lot == "3"]
    assert ids == ["9-3-0", "9-3-1"]


def test_a_lot_above_a_hundred_stands_by_the_lot_it_was_split_from() -> None:
    fronts, _ = laid_out([*PLAIN, *entries(("109", "West 11 Street", ""))])
    assert walk(fronts)[5:9] == ["8", "9", "109", "10"]


def test_a_street_with_odd_and_even_numbers_cuts_the_block_in_two_rings() -> None:
    fronts, _ = laid_out(CUT)
    assert walk(fronts, 0) == ["3", "4", "6", "7", "20", "2", "1"]
    assert walk(fronts, 1) == ["10", "11", "13", "15", "16", "18", "9"]


CUT = entries(
    ("1", "7 Avenue", "561"),
    ("2", "7 Avenue", "567"),
    ("3", "West 40 Street", "147"),
    ("4", "West 40 Street", "143"),
    ("6", "Broadway", "1431"),
    ("7", "Broadway", "1437"),
    ("9", "Broadway", "1434"),
    ("10", "West 40 Street", "119"),
    ("11", "West 40 Street", "105"),
    ("13", "6 Avenue", "1071"),
    ("15", "West 41 Street", "108"),
    ("16", "West 41 Street", "120"),
    ("18", "Broadway", "1446"),
    ("20", "Broadway", "1441"),
)


def test_a_ring_keeps_the_side_on_which_it_lists_no_lot() -> None:
    fronts, _ = laid_out(CUT)
    sides = {one.street: one.side for one in fronts if one.ring == 0}
    assert sides == {"West 40 Street": 0, "Broadway": 1, "7 Avenue": 3}


def test_the_numbers_of_a_street_run_one_way_in_all_its_blocks() -> None:
    lone = entries(
        ("1", "West 11 Street", "139"), ("2", "West 11 Street", "131"), block="10"
    )
    law, _ = directions(
        [[("west 11 street", -1, 3.0)], [("west 11 street", 1, 0.0)]],
    )
    assert law == {"west 11 street": -1}
    fronts, _ = laid_out([*PLAIN, *lone])
    assert [one.address for one in fronts if one.block == "10"] == ["139", "131"]


def test_opposite_sides_settle_a_street_that_too_few_lots_speak_for() -> None:
    ring = [("a", 1, -6.0), ("east", 1, 6.0), ("b", -1, 6.0), ("west", 1, 1.0)]
    assert directions([ring])[0] == {"a": -1, "east": 1, "b": -1, "west": -1}


def test_a_number_that_runs_against_the_lots_is_named_and_set_aside() -> None:
    swapped = entries(
        ("1", "Elm", "101"),
        ("2", "Elm", "109"),
        ("3", "Elm", "105"),
        ("4", "Elm", "113"),
    )
    fronts, warnings = laid_out(swapped)
    assert walk(fronts) == ["1", "2", "3", "4"]
    assert "lot 2 (109 Elm)" in warnings[0]
    assert "lot 3 (105 Elm)" in warnings[1]


def test_sides_that_a_catalogue_gives_are_taken() -> None:
    given = [
        {"block": "1", "lot": lot, "side": side, "order": order}
        for lot, side, order in (("c", "1", "1"), ("a", "0", "2"), ("b", "0", "1"))
    ]
    fronts, _ = laid_out(catalogue.read(given).entries)
    assert [(one.lot, one.side, one.rank) for one in fronts] == [
        ("b", 0, 0),
        ("a", 0, 1),
        ("c", 1, 2),
    ]


def test_lots_without_streets_stand_in_one_row() -> None:
    fronts, _ = laid_out(entries(("2", "", ""), ("1", "", ""), ("10", "", "")))
    assert walk(fronts) == ["1", "2", "10"]
    assert {one.side for one in fronts} == {0}


def test_front_ids_are_unique() -> None:
    ids = [one.front_id for one in laid_out(CUT)[0]]
    assert len(ids) == len(set(ids))


@needs_data
@pytest.mark.parametrize(("block", "others"), [("993", False), ("993", True)])
def test_block_993_comes_out_as_it_stood(block: str, *, others: bool) -> None:
    fronts, _ = laid_out(listed(None if others else block))
    fronts = tuple(one for one in fronts if one.block == block)
    assert walk(fronts, 0) == ["104", "5", "7", "8", "10", "55", "3", "1"]
    assert walk(fronts, 1)[3:] == ["36", "38", "43", "47", "11"]
    assert sorted(walk(fronts, 1)[:3]) == ["22", "25", "29"]


@needs_data
@pytest.mark.parametrize("block", ["996", "997"])
def test_house_numbers_run_along_every_side_of_the_whole_blocks(block: str) -> None:
    fronts = [one for one in laid_out(listed())[0] if one.block == block]
    assert {one.ring for one in fronts} == {0}
    falling = {"West 43 Street", "Broadway"} | (
        {"West 44 Street"} if block == "997" else set()
    )
    for street in {one.street for one in fronts}:
        numbers = [
            int(one.address.split("-")[0]) for one in fronts if one.street == street
        ]
        assert numbers == sorted(numbers, reverse=street in falling)


def listed(block: str | None = None) -> list[Entry]:
    """Read the archive's list, or one block of it."""
    text = (DATA / "taxphotos/catalogue.csv").read_text("utf-8-sig").splitlines()
    entries = catalogue.read(list(csv.DictReader(text))).entries
    return [one for one in entries if block in (None, one.block)]


def test_strange_catalogues_make_fronts_of_different_names_and_blocks_that_stand() -> (
    None
):
    rng = np.random.default_rng(5)
    streets = ["", "Broadway", "West 1 Street", "West 2 Street", "A Avenue", "rue X"]
    numbers = ["", "rear", "7", "12", "101-109", "130", "132-6"]
    for _ in range(6):
        rows = [
            (f"{rng.integers(1, 150)}", rng.choice(streets), rng.choice(numbers))
            for _ in range(rng.integers(1, 14))
        ]
        fronts, _ = laid_out(entries(*rows))
        ids = [one.front_id for one in fronts]
        assert len(ids) == len(set(ids))
        built = block.block("9", fronts, [], {})
        stood = [w.front_id for one in built.buildings for w in one.walls if w.front_id]
        assert sorted(stood) == sorted(ids)


def test_one_lot_is_a_block() -> None:
    (only,), told = laid_out(entries(("7", "West 10 Street", "139")))
    assert (only.lot, only.ring, only.side, only.rank) == ("7", 0, 0, 0)
    assert not told
    assert len(block.block("9", [only], [], {}).buildings) == 1


def test_a_thousand_lots_without_a_width_stand_in_order() -> None:
    streets = ("West 1 Street", "1 Avenue", "West 2 Street", "2 Avenue")
    first = (2001, 1, 1000, 4001)
    step = (-2, 2, 2, -2)
    rows = [
        (str(250 * k + i + 1), street, str(first[k] + step[k] * i))
        for k, street in enumerate(streets)
        for i in range(250)
    ]
    fronts, told = laid_out(entries(*rows))
    assert walk(fronts) == [lot for lot, *_ in rows]
    assert not told
    assert all(one.width_assumed for one in fronts)


def test_a_lot_on_no_street_stands_by_its_number_and_its_neighbours() -> None:
    bare = [*PLAIN[:1], replace(PLAIN[1], street=""), *PLAIN[2:]]
    fronts, told = laid_out(bare)
    assert walk(fronts) == walk(laid_out(PLAIN)[0])
    assert fronts[1].street == "West 10 Street"
    assert "lot 2 (137): row 3: it names no street" in told[0]


def test_a_street_that_is_changed_is_told_with_the_row_and_one_that_stays_too() -> None:
    """Lot 2's street is another's, so that it moves; lot 10's number is what is odd."""
    moved = replace(PLAIN[1], street="West 11 Street", row=7)
    odd = replace(PLAIN[7], address="13600", row=9)
    fronts, told = laid_out([PLAIN[0], moved, *PLAIN[2:7], odd, *PLAIN[8:]])
    streets = {one.lot: one.street for one in fronts}
    (first,) = [line for line in told if "lot 2 (137 West 11 Street): row 7: " in line]
    assert streets["2"] == "West 10 Street"
    assert "it is taken as on West 10 Street; mend row 7 if it is wrong" in first
    (last,) = [line for line in told if "lot 10 (13600 West 11 Street): row 9" in line]
    assert streets["10"] == "West 11 Street"
    assert "it is left as written; mend row 9" in last


def test_lots_that_contradict_each_other_name_all_their_rows() -> None:
    """As block 993's lots 22, 25 and 29 do: 115-119, 105 and 111."""
    numbers = {"2": "133", "3": "137"}  # of lots 1 to 3: 139, 133, 137
    rows = [
        replace(one, address=numbers.get(one.lot, one.address), row=row)
        for row, one in enumerate(PLAIN, 20)
    ]
    _, told = laid_out(rows)
    found = [line for line in told if "contradict each other" in line]
    assert len(found) > 1
    for line in found:
        own = int(line.partition("): row ")[2].partition(":")[0])
        others = {int(x.split()[0].strip(",")) for x in line.split(" in row ")[1:]}
        assert others
        assert own not in others
        assert f"mend row {own} if it is wrong" in line


def test_two_lots_with_one_key_are_both_kept_and_told() -> None:
    twice = entries(("3", "West 10 Street", "131-135"), ("3", "West 10 Street", "129"))
    twice = [replace(one, row=90 + k) for k, one in enumerate(twice)]
    rows = [one for one in PLAIN if one.lot != "3"]
    fronts, told = laid_out([*rows, *twice])
    assert walk(fronts) == walk(laid_out(PLAIN)[0])
    assert "row 90 says 131-135 West 10 Street, row 91 says 129" in told[0]


def test_letters_and_halves_stand_between_whole_numbers() -> None:
    rows = [
        ("1", "Elm", "31"),
        ("2", "Elm", "33"),
        ("2A", "Elm", "33 1/2"),
        ("3", "Elm", "35"),
        ("4", "Elm", "37½"),
        ("5", "Elm", "39-43"),
    ]
    fronts, told = laid_out(entries(*rows))
    assert walk(fronts) == ["1", "2", "2A", "3", "4", "5"]
    assert not told


def test_a_single_lot_can_be_an_island() -> None:
    alone = [one for one in CUT if one.lot not in {"1", "2", "3", "4", "7", "20"}]
    fronts, told = laid_out(alone)
    assert walk(fronts, 0) == ["6"]
    assert sorted(walk(fronts, 1)) == sorted(o.lot for o in alone if o.lot != "6")
    assert "lot 6 (1431 Broadway): row 6: it has a ring to itself" in told[0]


def test_a_number_of_the_other_parity_makes_no_island() -> None:
    slipped = [replace(one, address="136") if one.lot == "2" else one for one in PLAIN]
    fronts, told = laid_out(slipped)
    assert walk(fronts) == walk(laid_out(PLAIN)[0])
    assert "the other numbers of its side are odd" in told[0]


def test_a_doubt_tells_programs_what_it_tells_people() -> None:
    rows = [replace(one, address="271") if one.lot == "19" else one for one in WHOLE]
    (one,) = rings.fronts(rows)[1]
    (row,) = [each for each in rows if each.lot == "19"]
    assert (one.block, one.lot, one.rows) == (row.block, "19", (row.row,))
    assert one.address == f"271 {row.street}"
    assert f"block {one.block}, lot 19 ({one.address}): row {row.row}: " in one.text
    assert one.likely
    assert one.text.endswith(f"; likeliest {' or '.join(one.likely)}")


def test_a_doubt_about_a_photo_tells_the_lot_of_its_name() -> None:
    cells = {"photo": "x_00009_0002.jpg", "block": "9", "lot": "1"}
    rows = catalogue.read([cells | {"street": "Elm", "address": "1"}]).entries
    (one,) = [each for each in rings.fronts(rows)[1] if each.photo]
    assert (one.block, one.lot, one.photo) == ("9", "1", cells["photo"])
    assert one.named == ("9", "2")


def test_no_number_is_the_likeliest_of_two_lots() -> None:
    south = {"104": "147", "5": "143-145", "22": "115-119", "25": "105", "29": "111"}
    rows = entries(
        *((lot, "West 40 Street", address) for lot, address in south.items()),
        *(("31", "Sixth Avenue", "1030"), ("33", "Sixth Avenue", "1032")),
        *(("40", "West 41 Street", "104"), ("42", "West 41 Street", "106")),
    )
    likely = [each for one in rings.fronts(rows)[1] for each in one.likely]
    assert len(likely) > 1
    assert len(likely) == len(set(likely))
