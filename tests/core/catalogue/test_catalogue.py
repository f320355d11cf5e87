from typing import Any

import pytest

from nostalgin_core.address import house_numbers
from nostalgin_core.catalogue import catalogue

ARCHIVE = {
    "Delete": "",
    "Borough": "Manhattan",
    "1940 Block Number": "993",
    "1940 Lot Number": "1",
    "1940 Building Number": "561-565",
    "1940 Street Name": "7 Avenue",
    "LOT FRONTAGE": "59.03",
    "LOT DEPTH": "0.60",
    "YEAR BUILT": "1925",
    "Date": "1939-1941",
    "File Name ": "nynyma_rec0040_1_00993_0001",
}
PLAIN = {
    "photo": "west/12.jpg",
    "block": "12",
    "lot": "7",
    "street": "Elm Street",
    "address": "14",
    "width_m": "6.5",
}


@pytest.mark.parametrize(
    ("address", "numbers"),
    [
        ("147", (147, 147)),
        ("561-565", (561, 565)),
        ("108-12", (108, 112)),
        ("147A", (147, 147)),
        ("17 1/2", (17, 17)),
        ("115\u2013119", (115, 119)),
        ("", None),
        ("rear", None),
        ("9" * 5000, None),
        ("7-" + "9" * 5000, (7, 7)),
    ],
)
def test_house_numbers(address: str, numbers: tuple[int, int] | None) -> None:
    assert house_numbers(address) == numbers


def test_the_archive_s_own_columns_are_known() -> None:
    read = catalogue.read([ARCHIVE])
    (entry,) = read.entries
    assert (entry.block, entry.lot, entry.street) == ("993", "1", "7 Avenue")
    assert entry.address == "561-565"
    assert entry.width_m == pytest.approx(59.25 * 0.3048, abs=1e-3)
    assert entry.depth_m == pytest.approx(60 * 0.3048, abs=1e-3)
    assert entry.photo == "nynyma_rec0040_1_00993_0001"
    assert not read.rejections
    assert not read.warnings


def test_lengths_of_a_later_building_are_left_out_with_a_warning() -> None:
    read = catalogue.read([ARCHIVE | {"YEAR BUILT": "1964"}])
    assert read.entries[0].width_m is None
    assert "row 2" in read.warnings[0]
    assert "1964" in read.warnings[0]


def test_a_plain_catalogue_is_read_and_unknown_columns_are_named() -> None:
    read = catalogue.read([PLAIN | {"mood": "grim"}], name="list.csv")
    assert read.entries[0].width_m == 6.5
    assert read.warnings == ("list.csv: column 'mood' is not known; it is kept",)


@pytest.mark.parametrize(
    ("cells", "reason"),
    [
        ({"photo": "../../etc/passwd"}, "path outside the photo folder"),
        ({"photo": "/etc/passwd"}, "path outside the photo folder"),
        ({"block": ""}, "no block"),
        ({"lot": ""}, "no lot"),
        ({"width_m": "wide"}, "nonsense width_m"),
        ({"width_m": "-3"}, "nonsense width_m"),
        ({"width_m": "0"}, "nonsense width_m"),
        ({"side": "north"}, "nonsense side"),
        ({"side": "1000000000"}, "nonsense side"),
        ({"side": "9" * 400}, "nonsense side"),
        ({"ring": "0.5"}, "nonsense ring"),
        ({"order": "9" * 400}, "nonsense order"),
        ({None: ["5", "7"]}, "too many cells"),
        ({"lot": "../1"}, "nonsense block or lot"),
    ],
)
def test_a_nonsense_row_is_rejected_by_its_number_and_spoils_no_other(
    cells: dict[Any, Any], reason: str
) -> None:
    read = catalogue.read([PLAIN, PLAIN | cells], name="list.csv")
    assert len(read.entries) == 1
    (rejection,) = read.rejections
    assert rejection.key == "list.csv row 3"
    assert rejection.reason == reason
    assert rejection.detail


def test_block_and_lot_come_from_the_file_name_where_columns_lack() -> None:
    read = catalogue.read([{"photo": "nynyma_rec0040_1_00993_0008a.jpg"}])
    assert (read.entries[0].block, read.entries[0].lot) == ("993", "8")


def test_a_photo_finds_its_row_by_name_or_by_lot_or_is_rejected() -> None:
    entries = catalogue.read([ARCHIVE]).entries
    by_name, by_lot, unknown = (
        "a/nynyma_rec0040_1_00993_0001.JPG",
        "other_00993_0001b.jpg",
        "holiday.jpg",
    )
    found, rejections = catalogue.matched(entries, [by_name, by_lot, unknown])
    assert set(found) == {by_name, by_lot}
    assert [one.key for one in rejections] == [unknown]


CORNER = {
    "Alternative Building Number": "155",
    "Alternative Street Name": "West 40 Street",
}


def test_an_accent_may_be_written_as_a_letter_of_its_own() -> None:
    entries = catalogue.read([PLAIN | {"photo": "caf\u00e9.jpg"}]).entries
    found, rejections = catalogue.matched(entries, ["cafe\u0301.jpg"])
    assert list(found) == ["cafe\u0301.jpg"]
    assert rejections == ()


def test_of_two_photos_of_one_name_each_finds_the_row_with_its_folder() -> None:
    rows = [
        PLAIN | {"photo": f"{folder}/12.jpg", "lot": lot}
        for folder, lot in (("west", "7"), ("east", "8"))
    ]
    entries = catalogue.read(rows).entries
    found, _ = catalogue.matched(entries, ["east/12.JPG", "west/12.jpg"])
    lots = {photo: [one.lot for one in some] for photo, some in found.items()}
    assert lots == {"east/12.JPG": ["8"], "west/12.jpg": ["7"]}


def test_a_row_may_name_a_folder_that_the_photos_have_left() -> None:
    entries = catalogue.read([PLAIN]).entries
    found, rejections = catalogue.matched(entries, ["12.jpg"])
    assert found == {"12.jpg": entries}
    assert not rejections


def test_empty_cells_beyond_the_last_column_do_no_harm() -> None:
    read = catalogue.read([PLAIN | {None: ["", " "]}])  # type: ignore[list-item]
    assert len(read.entries) == 1
    assert not read.warnings


def test_an_alternative_address_is_a_corner_lot_s_second_front() -> None:
    first, second = catalogue.read([ARCHIVE | CORNER]).entries
    assert (second.street, second.address) == ("West 40 Street", "155")
    assert (second.width_m, second.depth_m) == (first.depth_m, first.width_m)
    assert second.lot == first.lot


def test_another_name_of_the_same_street_is_no_second_front() -> None:
    renamed = CORNER | {"Alternative Building Number": "561-565"}
    assert len(catalogue.read([ARCHIVE | renamed]).entries) == 1


@pytest.mark.parametrize(
    ("street", "address", "photo"),
    [
        ("Elm St.", "14-16", "a.jpg"),
        ("Broadway / Fifth Ave", "12 1/2", "b.jpg"),
        ("Rue de l'Abb\u00e9-Gr\u00e9goire", "", "x" * 80 + ".jpg"),
        ("../etc\\passwd", "../../1", "c.jpg"),
        ("=cmd|calc", "-1+1", "d.jpg"),
    ],
)
def test_a_house_without_block_and_lot_has_a_key_that_corrections_can_name(
    street: str, address: str, photo: str
) -> None:
    row = {"photo": photo, "street": street, "address": address}
    made = catalogue.read([row, row | {"street": street.upper()}])
    assert not made.rejections
    keys = {(one.block, one.lot) for one in made.entries}
    assert len(keys) == 1
    (block, lot), *_ = keys
    assert f"{block}-{lot}".rpartition("-") == (block, "-", lot)
    assert not set(block + lot) & set("/\\\0")
    assert len(block + lot) <= 64
