from pathlib import Path

import pytest

from pipelines.index import anchors, places
from pipelines.index.anchors import Asked
from pipelines.index.images import Nothing
from pipelines.store import Store

BLOCKS = ["993", "996", "997"]
TABLE = b"block,lon,lat,bearing\n993,-73.9867,40.7545,119\n0996,-73.9846,40.7563,\n"


def test_places_read_back_as_they_were_written() -> None:
    found, told = places.read(TABLE, "places.csv")
    assert told == []
    again, _ = places.read(places.written(found), "places.csv")
    assert {b: one.longitude_deg for b, one in again.items()} == {
        b: one.longitude_deg for b, one in found.items()
    }
    assert again["993"].bearing_deg == 119.0
    assert found["993"].bearing_deg == 119.0
    assert found["0996"].bearing_deg is None


@pytest.mark.parametrize(
    ("row", "words"),
    [
        ("997,-73.98,91,", "outside the globe: lat is 91"),
        ("997,200,40,", "outside the globe: lon is 200"),
        ("997,40.75,-173.98,", "swapped"),
        ("997,x,40,", "no number"),
        ("997,,40,", "empty"),
        ("997,nan,40,", "no number"),
        (",-73.98,40.7,", "names no block"),
        ("993,-73.98,40.7,", "places block 993 again"),
        ("997,-73.98,40.7,north", "no number"),
    ],
)
def test_a_row_that_makes_no_sense_is_named_and_spoils_no_other(
    row: str, words: str
) -> None:
    found, told = places.read(TABLE + f"{row}\n".encode(), "places.csv")
    assert list(found) == ["993", "0996"]
    assert len(told) == 1
    assert "places.csv row 4" in told[0]
    assert words in told[0]


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "empty"),
        (b"block,lon,lat\n", "empty"),
        (b"a,b\n1,2\n", "write block, lon, lat"),
        (b"block|lon|lat\n1|2|3\n", "commas"),
        (b"\xff\xfe", "UTF-8"),
    ],
)
def test_a_useless_table_names_its_fault(data: bytes, words: str) -> None:
    with pytest.raises(places.NoPlaces, match=words):
        places.read(data, "places.csv")


@pytest.mark.parametrize("asked", ["40.7", "a,b,c", "95,0,0", "40,-74,400", "1,2,3,4"])
def test_a_place_that_is_none_is_refused(asked: str) -> None:
    with pytest.raises(places.NoPlaces, match="--place"):
        places.place(asked)


def test_a_place_is_latitude_first() -> None:
    one = places.place("40.75, -73.98, 119")
    assert (one.latitude_deg, one.longitude_deg, one.bearing_deg) == (
        40.75,
        -73.98,
        119,
    )


def test_streets_are_found_whatever_their_case() -> None:
    data = b"street,width_m\nWest  44 Street,18.5\nBroad Street,x\nMain,1000\n"
    widths, told = places.streets(data, "streets.csv")
    assert widths == {"west 44 street": 18.5}
    assert [one.split(":")[0] for one in told] == [
        "streets.csv row 3 has a width_m that is 'x', no number",
        "streets.csv row 4",
    ]


def test_what_index_writes_build_reads(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_bytes(TABLE)
    asked = Asked(places=tmp_path / "p.csv", place="40,-73,10")
    files, told = anchors.taken(asked, BLOCKS)
    assert "does not place 997" in " ".join(told)
    store = Store(str(tmp_path / "city"))
    for name, data in files.items():
        store.write_bytes(name, data)
    found = anchors.load(store, BLOCKS)
    assert sorted(found.of) == ["993", "996"]
    assert found.of["993"].bearing_deg == 119.0
    assert found.warnings == ()


def test_the_whole_city_is_placed_by_its_first_block(tmp_path: Path) -> None:
    files, _ = anchors.taken(Asked(place="40,-73,10"), BLOCKS)
    store = Store(str(tmp_path))
    store.write_bytes(places.PLACES, files[places.PLACES])
    assert list(anchors.load(store, BLOCKS).of) == ["993"]


def test_another_table_is_another_city(tmp_path: Path) -> None:
    store = Store(str(tmp_path))
    assert anchors.load(store, BLOCKS).sha256 == ""
    store.write_bytes(places.PLACES, TABLE)
    one = anchors.load(store, BLOCKS).sha256
    assert one == anchors.load(store, BLOCKS).sha256
    store.write_bytes(places.PLACES, TABLE.replace(b"119", b"118"))
    assert anchors.load(store, BLOCKS).sha256 != one


def test_a_table_spoiled_by_hand_is_told_and_left_out(tmp_path: Path) -> None:
    store = Store(str(tmp_path))
    store.write_bytes(places.PLACES, b"no table")
    store.write_bytes("outlines.geojson", b"{")
    found = anchors.load(store, BLOCKS)
    assert found.of == {}
    assert len(found.warnings) == 2
    assert all("left out" in one for one in found.warnings)


def test_a_file_that_is_not_there_is_refused_by_name(tmp_path: Path) -> None:
    with pytest.raises(Nothing, match=r"none\.csv"):
        anchors.taken(Asked(places=tmp_path / "none.csv"), BLOCKS)
    with pytest.raises(Nothing, match="name another file"):
        anchors.taken(Asked(outlines=tmp_path), BLOCKS)


def test_a_huge_file_is_refused_before_it_is_read(tmp_path: Path) -> None:
    huge = tmp_path / "huge.geojson"
    with huge.open("wb") as file:
        file.truncate(10**10)
    with pytest.raises(Nothing, match="huge"):
        anchors.taken(Asked(outlines=huge), BLOCKS)
