"""Lists of other makers, and what they tell beside a photograph's place."""

import json
from pathlib import Path
from typing import Any

import pytest

from pipelines.index import dates, manifest, objects
from pipelines.index.images import Nothing
from pipelines.index.index import Indexed, index
from pipelines.store import Store
from tests.pipelines.hostile import hostile

TAX: dict[str, Any] = {
    "identifier": "nynyma_rec0040_1_00993_0008",
    "collection": "1940",
    "borough": "Manhattan",
    "block": 993,
    "lot": "8",
    "bldgNumberStart": "561",
    "bldgNumberEnd": "565",
    "streetName": "7 Avenue",
    "sideOfStreet": "W",
}


def written(folder: Path, name: str, data: Any, *photos: str) -> Indexed:
    (folder / "photos").mkdir()
    for photo in photos:
        (folder / "photos" / photo).write_bytes(b"x")
    words = data if isinstance(data, str) else json.dumps(data)
    (folder / name).write_text(words, newline="")
    return index(folder / "photos", folder / name, str(folder / "city"))


def rows(folder: Path) -> list[manifest.Row]:
    return list(manifest.read(Store(str(folder / "city"))).rows)


def test_1940s_nyc_s_photographs_are_a_list(tmp_path: Path) -> None:
    written(tmp_path, "list.json", [TAX], "nynyma_rec0040_1_00993_0008.jpg")
    (row,) = rows(tmp_path)
    assert row.front is not None
    assert (row.front.block, row.front.lot) == ("993", "8")
    assert (row.front.street, row.front.address) == ("7 Avenue", "561-565")
    assert row.cells["series"] == "1940"  # a year is nobody to credit
    assert row.credit == ""


@pytest.mark.parametrize("sign", [",", ";", "\t"])
def test_a_list_may_part_its_cells_as_any_spreadsheet_does(
    tmp_path: Path, sign: str
) -> None:
    list_csv = "photo,block,lot,street,address\na.jpg,5,1,Elm Street,12\n"
    made = written(tmp_path, "list.csv", list_csv.replace(",", sign), "a.jpg")
    (row,) = rows(tmp_path)
    assert row.front is not None
    assert (row.front.block, row.front.lot, row.front.address) == ("5", "1", "12")
    assert not made.rejections


def test_a_list_without_any_known_column_names_its_own_and_those_wanted(
    tmp_path: Path,
) -> None:
    with pytest.raises(Nothing, match=r"'Foto', 'Blok'.*photo, block, lot") as told:
        written(tmp_path, "list.csv", "Foto;Blok\na.jpg;5\n", "a.jpg")
    assert "docs/lists.md" in str(told.value)


def test_oldnyc_s_photographs_stand_by_their_places(tmp_path: Path) -> None:
    record = {
        "id": "705161f-a",
        "photo_url": "http://images.example.org/705161f",
        "preferred_url": "http://example.org/705161f",
        "location": "Joralemon Street & Clinton Street, Brooklyn, NY",
        "date": "1928",
        "title": "Brooklyn: Joralemon Street",
    }
    lines = "\n".join(json.dumps(record | {"id": one}) for one in ("a-1", "a-2"))
    written(tmp_path, "list.ndjson", lines, "a-1.jpg", "a-2.jpg")
    found = rows(tmp_path)
    assert len({row.front and row.front.block for row in found}) == 1
    assert [row.told["date"] for row in found] == ["1928", "1928"]
    assert found[0].told["source_url"] == "http://example.org/705161f"
    assert found[0].cells["photo_url"] == "http://images.example.org/705161f"


def test_a_geojson_feature_keeps_its_place(tmp_path: Path) -> None:
    point = {"type": "Point", "coordinates": [-73.98, 40.75]}
    own = {"photo": "a.jpg", "block": 5, "lot": 1}
    feature = {"type": "Feature", "geometry": point, "properties": own}
    data = {"type": "FeatureCollection", "features": [feature]}
    written(tmp_path, "list.geojson", data, "a.jpg")
    assert (rows(tmp_path)[0].cells["lon"], rows(tmp_path)[0].cells["lat"]) == (
        "-73.98",
        "40.75",
    )


def test_a_record_that_makes_no_sense_spoils_no_other(tmp_path: Path) -> None:
    bad = [7, TAX | {"block": {"a": 1}}]
    made = written(tmp_path, "list.json", [*bad, TAX], "a.jpg")
    assert [one.key for one in made.rejections][:2] == [
        "list.json record 1",
        "list.json record 2",
    ]
    assert made.fronts == 1


@pytest.mark.parametrize(
    "odd",
    [{"street": "\ud800x"}, {"note": "\udfff"}, {"\udc00": "x"}, {"block": "\ud83d"}],
)
def test_half_a_letter_costs_its_record_alone(
    tmp_path: Path, odd: dict[str, str]
) -> None:
    records = [{"photo": f"{n}.jpg", "block": "5", "lot": str(n)} for n in (1, 2)]
    made = written(tmp_path, "l.json", [records[0] | odd, records[1]], "1.jpg", "2.jpg")
    (one, *_) = made.rejections
    assert (one.key, one.reason) == ("l.json record 1", "nonsense record")
    assert one.detail.endswith("; mend the record")
    assert [row.front.lot for row in rows(tmp_path) if row.front] == ["2"]


@pytest.mark.parametrize("mark", ["\u2028", "\x85", "\u2029"])
def test_a_text_of_a_record_a_line_may_hold_any_line_end_but_one(mark: str) -> None:
    lines = [
        json.dumps({"photo": f"{n}.jpg", "note": f"a{mark}b"}, ensure_ascii=False)
        for n in range(2)
    ]
    read = objects.rows("\n".join(lines).encode(), "l.jsonl")
    assert [row["note"] for row in read.rows] == [f"a{mark}b"] * 2


def test_the_plain_list_of_four_columns_is_read(tmp_path: Path) -> None:
    text = "borough,block,lot,filename\n1,993,8,dof_1.jpg\n"
    made = written(tmp_path, "list.csv", text, "dof_1.jpg")
    assert (made.photos, made.without_front, made.warnings) == (1, (), ())


def test_a_list_of_two_boroughs_is_warned_of(tmp_path: Path) -> None:
    text = "borough,block,lot,filename\n1,993,8,a.jpg\n3,993,8,b.jpg\n"
    made = written(tmp_path, "list.csv", text, "a.jpg", "b.jpg")
    assert any("2 boroughs (1, 3)" in one for one in made.warnings)


def test_rights_licence_date_and_unknown_columns_reach_the_manifest(
    tmp_path: Path,
) -> None:
    text = (
        "photo,block,lot,Licence,rights_statement,date,mood,root\n"
        "a.jpg,5,1,CC0,No known restrictions,c. 1940,grim,elm\n"
        ",5,3,,,between the wars,,\n"
    )
    made = written(tmp_path, "list.csv", text, "a.jpg")
    first, other = rows(tmp_path)
    assert first.told == {
        "rights": "No known restrictions",
        "license": "CC0",
        "date": "1940~",
    }
    assert (first.cells["mood"], first.cells["list_root"]) == ("grim", "elm")
    assert other.told == {"date_as_written": "between the wars"}
    assert any("'between the wars' (1 rows) is no EDTF" in w for w in made.warnings)


def test_a_formula_in_a_kept_column_is_written_harmlessly(tmp_path: Path) -> None:
    text = "photo,block,lot,mood\na.jpg,5,1,=1+1\n"
    written(tmp_path, "list.csv", text, "a.jpg")
    assert ",'=1+1" in (tmp_path / "city" / "manifest.csv").read_text()
    assert rows(tmp_path)[0].cells["mood"] == "=1+1"


@pytest.mark.parametrize(
    ("written_so", "meant"),
    [
        ("1939-1941", "1939/1941"),
        ("circa 1940", "1940~"),
        ("1940?", "1940?"),
        ("194X", "194X"),
        ("June 1939", "1939-06"),
        ("1941-1939", None),  # in which order?
        ("1940-13", None),
        ("1860s or 1870s", None),  # half of it would be lost
        ("1/2/1939", None),  # January or February?
        ("", None),
        ("1" * 10_000, None),
    ],
)
def test_a_date_is_edtf_or_is_left_as_it_is(written_so: str, meant: str | None) -> None:
    assert dates.edtf(written_so) == meant


@pytest.mark.parametrize("value", ["1939/1941", "1940~", "194X", "1939-06", "1940"])
def test_edtf_is_left_as_it_is(value: str) -> None:
    assert dates.edtf(value) == value


@pytest.mark.parametrize(
    "data", ["", "no json", "7", "null", '"x"', "[" * 100_000, "[]", "{}", "[[]]"]
)
def test_json_that_is_no_list_is_refused_in_words(data: str, tmp_path: Path) -> None:
    with pytest.raises(Nothing, match=r"list\.json"):
        written(tmp_path, "list.json", data, "a.jpg")


@pytest.mark.parametrize("name", ["list.json", "list.ndjson", "list.geojson"])
def test_a_pipe_is_no_list(name: str, tmp_path: Path) -> None:
    hostile(tmp_path / name, "pipe")
    (tmp_path / "a.jpg").write_bytes(b"x")
    with pytest.raises(Nothing, match="Not a regular file"):
        index(tmp_path, tmp_path / name, str(tmp_path / "city"))


def test_objects_are_numbered_as_they_stand() -> None:
    read = objects.rows(json.dumps([TAX, 1, TAX]).encode(), "x")
    assert len(read.rows) == 3
    assert read.rejections[0].key == "x record 2"
