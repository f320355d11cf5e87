import csv
from dataclasses import replace
from typing import Any

from nostalgin_core.block import corner
from nostalgin_core.catalogue import catalogue, rings
from nostalgin_core.records import Front
from tests.core.listed import front
from tests.data import DATA, needs_data


def numbered(side: int, rank: int, lot: str, **more: Any) -> Front:
    number = f"{100 + 2 * rank}"
    return front(lot, side, rank, address=number, depth_m=14.0, **more)


FRONTS = tuple(
    numbered(side, 3 * side + k, f"{side}{'abc'[k]}")
    for side in range(4)
    for k in range(3)
)


def ids(fronts: tuple[Front, ...]) -> list[str]:
    return [one.front_id for one in fronts]


def test_without_corner_photos_nothing_changes() -> None:
    assert corner.with_corners(FRONTS, set()) == FRONTS


def test_the_last_lot_of_a_side_goes_round_to_the_next() -> None:
    turned = corner.with_corners(FRONTS, {"9-0c"})
    assert ids(turned)[2:4] == ["9-0c-0", "9-0c-1"]
    assert turned[3].width_m == 14.0
    assert turned[3].depth_m == 10.0
    assert turned[3].address == ""
    assert turned[3].street == "street 1"


def test_the_first_lot_of_a_side_comes_round_from_the_one_before() -> None:
    turned = corner.with_corners(FRONTS, {"9-0a"})
    assert ids(turned)[-1] == "9-0a-3"
    assert ids(turned)[0] == "9-0a-0"


def test_house_numbers_beat_a_guessed_corner() -> None:
    turned = corner.with_corners(FRONTS, {"9-1a", "9-1b"})
    assert ids(turned)[3:8] == ["9-1a-0", "9-1a-1", "9-1b-1", "9-1c-1", "9-2a-2"]


def test_without_numbers_a_lot_seen_round_a_corner_moves_to_the_end_of_its_side() -> (
    None
):
    bare = tuple(replace(one, address="") for one in FRONTS)
    turned = corner.with_corners(bare, {"9-1a", "9-1b"})
    assert ids(turned)[3:8] == ["9-1a-0", "9-1a-1", "9-1c-1", "9-1b-1", "9-1b-2"]


def test_a_lot_alone_on_its_side_takes_the_corner_that_is_left() -> None:
    few = (
        numbered(0, 0, "a"),
        numbered(0, 1, "b"),
        numbered(1, 2, "c"),
        numbered(2, 3, "d"),
        numbered(3, 4, "e"),
    )
    turned = corner.with_corners(few, {"9-b", "9-c"})
    assert ids(turned)[1:5] == ["9-b-0", "9-b-1", "9-c-1", "9-c-2"]


def test_no_corner_is_given_twice() -> None:
    turned = corner.with_corners(FRONTS, {"9-0c", "9-1a"})
    assert ids(turned)[2:5] == ["9-0c-0", "9-0c-1", "9-1a-1"]
    assert len(turned) == len(FRONTS) + 1


def test_ranks_count_round_each_ring() -> None:
    turned = corner.with_corners(FRONTS, {"9-0c", "9-2a"})
    assert [one.rank for one in turned] == list(range(len(turned)))


def test_a_straight_row_has_no_corners() -> None:
    row = tuple(numbered(0, k, f"{k}") for k in range(3))
    assert corner.with_corners(row, {"9-0", "9-2"}) == row


@needs_data
def test_block_993_comes_out_as_its_photographs_show_it() -> None:
    text = (DATA / "taxphotos/catalogue.csv").read_text("utf-8-sig").splitlines()
    entries = catalogue.read(list(csv.DictReader(text))).entries
    fronts, _ = rings.fronts([one for one in entries if one.block == "993"])
    seen_round = {f"993-{lot}" for lot in (1, 7, 11, 29, 36, 47, 55)}
    turned = corner.with_corners(fronts, seen_round)
    rounds = [
        [f"{one.lot}@{one.street}" for one in turned if one.ring == k] for k in (0, 1)
    ]
    assert rounds[0] == [
        "1@West 40 Street",
        "104@West 40 Street",
        "5@West 40 Street",
        "7@West 40 Street",
        "7@Broadway",
        "8@Broadway",
        "10@Broadway",
        "55@Broadway",
        "55@West 41 Street",
        "3@7 Avenue",
        "1@7 Avenue",
    ]
    assert rounds[1] == [
        "11@West 40 Street",
        "22@West 40 Street",
        "25@West 40 Street",
        "29@West 40 Street",
        "29@Avenue of the Americas",
        "36@Avenue of the Americas",
        "36@West 41 Street",
        "38@West 41 Street",
        "43@West 41 Street",
        "47@West 41 Street",
        "47@Broadway",
        "11@Broadway",
    ]


def test_a_lot_that_the_catalogue_names_on_two_streets_stands_at_their_corner() -> None:
    fronts = list(FRONTS)
    fronts[1] = replace(fronts[1], front_id="9-0x-0", lot="0x")
    fronts[4] = replace(fronts[4], front_id="9-0x-1", lot="0x")
    assert ids(corner.with_corners(fronts, set()))[2:4] == ["9-0x-0", "9-0x-1"]
