"""Corrections: read each by itself, merged, and obeyed by a build."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from nostalgin_core.records import Front
from pipelines import corrections
from pipelines.build.corrected import corrected
from pipelines.cli import app
from pipelines.corrections.corrections import Corrections
from pipelines.index import manifest, source
from pipelines.index.manifest import Unusable
from pipelines.index.row import Row
from pipelines.store import Store
from tests.pipelines import painted
from tests.pipelines.cities import artifacts, built, tree
from tests.pipelines.told import told_buildings

HEAD = "photo,front_id,building_id,what,value,note\n"


def front(lot: int, rank: int, side: int = 0, width_m: float = 7.62) -> Front:
    named = f"5-{lot}-{side}"
    where = {"street": "Elm Street", "address": str(lot), "depth_m": None}
    return Front(
        named,
        "5",
        str(lot),
        0,
        side,
        rank,
        width_m=width_m,
        width_assumed=True,
        **where,
    )


ROWS = tuple(
    Row(number, "/photos", f"5_{lot}.png", front(lot, lot - 1, side), "", {})
    for number, (lot, side) in enumerate([(1, 0), (2, 0), (3, 0), (4, 1)], 2)
)


def read(folder: Path, *lines: str) -> Corrections:
    (folder / "corrections.csv").write_text(HEAD + "\n".join(lines) + "\n")
    return corrections.read(Store(str(folder)))


def order(rows: tuple[Row, ...]) -> list[str]:
    fronts = sorted((r.front for r in rows if r.front), key=lambda one: one.rank)
    assert [one.rank for one in fronts] == list(range(len(fronts)))
    return [one.lot for one in fronts]


def test_without_corrections_nothing_is_changed(tmp_path: Path) -> None:
    none = corrections.read(Store(str(tmp_path)))
    made = corrections.applied(ROWS, none)
    assert (made.rows, made.changes, made.rejections) == (ROWS, (), ())
    assert none.sha256 == ""


def test_a_key_moves_a_photo_and_loses_no_front(tmp_path: Path) -> None:
    made = corrections.applied(ROWS, read(tmp_path, "5_1.png,,,key,5-3,the board"))
    shown = {(row.photo, row.front.lot) for row in made.rows if row.front}
    assert shown == {
        ("", "1"),
        ("5_2.png", "2"),
        ("5_3.png", "3"),
        ("5_1.png", "3"),
        ("5_4.png", "4"),
    }
    (change,) = made.changes
    assert (change.before, change.after, change.note) == ("5-1", "5-3", "the board")


def test_a_board_s_reading_is_a_key_and_the_later_counts(tmp_path: Path) -> None:
    given = read(tmp_path, "5_1.png,,,placard,5-3,", "5_1.png,,,key,5-2,")
    (change,) = corrections.applied(ROWS, given).changes
    assert change.after == "5-2"


def test_an_earlier_row_about_the_same_is_told_with_the_one_that_counts(
    tmp_path: Path,
) -> None:
    city = tmp_path / "city"
    city.mkdir()
    cells = [manifest.row_of(r.photo, r.front, root="", credit="") for r in ROWS]
    manifest.write(Store(str(city)), cells)
    widths = [f",5-2-0,,width_m,{value}," for value in (6, 7, 8)]
    given = read(city, widths[0], ",5-1-0,,width_m,9,", *widths[1:])
    rows = [f"corrections.csv row {number}" for number in (2, 4, 5)]
    told = [(old.row, by) for old, by in given.superseded]
    assert told == [(rows[0], rows[2]), (rows[1], rows[2])]
    result = CliRunner().invoke(app, ["corrections", str(city)])
    assert f"{rows[0]}: width_m of 5-2-0 is superseded by {rows[2]}" in result.output


def test_a_width_is_known_no_longer_assumed(tmp_path: Path) -> None:
    made = corrections.applied(ROWS, read(tmp_path, ",5-2-0,,width_m,6.1,"))
    (wide,) = [r.front for r in made.rows if r.front and r.front.lot == "2"]
    assert wide == replace(front(2, 1), width_m=6.1, width_assumed=False)
    assert made.changes[0].before == "7.62 assumed"
    assert [r for r in made.rows if r.front and r.front.lot != "2"] == [
        r for r in ROWS if r.front and r.front.lot != "2"
    ]


@pytest.mark.parametrize(
    ("value", "lots"),
    [
        ("-1", ["3", "1", "2", "4"]),
        ("0.5", ["1", "3", "2", "4"]),
        ("2", ["1", "2", "3", "4"]),
        ("9", ["1", "2", "4", "3"]),
    ],
)
def test_an_order_is_a_permutation(value: str, lots: list[str], tmp_path: Path) -> None:
    made = corrections.applied(ROWS, read(tmp_path, f",5-3-0,,order,{value},"))
    assert order(made.rows) == lots
    assert made.rejections == ()


def test_a_front_takes_the_side_that_it_is_moved_to(tmp_path: Path) -> None:
    made = corrections.applied(ROWS, read(tmp_path, ",5-4-1,,order,0.5,"))
    (moved,) = [r.front for r in made.rows if r.front and r.front.lot == "4"]
    assert (moved.rank, moved.side) == (1, 0)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("x.png,,,key,5-3,", "no such photo"),
        ("5_1.png,,,key,5-77,", "no such lot"),
        ("5_1.png,,,key,five,", "nonsense correction"),
        (",,,key,5-3,", "nonsense correction"),
        (",5-9-0,,width_m,6,", "no such front"),
        (",5-1-0,,width_m,nan,", "nonsense correction"),
        (",5-1-0,,width_m,0.1,", "nonsense correction"),
        (",5-1-0,,width_m,wide,", "nonsense correction"),
        (",5-9-0,,order,1,", "no such front"),
        (",,5-9,height_m,12,", "no such building"),
        (",,5-1,height_m,inf,", "nonsense correction"),
        ("x.png,,,target,12,", "no such photo"),
        ("5_1.png,,,mood,12,", "nonsense correction"),
        (f"5_1.png,,,key,{'9' * 5000}-1,", "nonsense correction"),
    ],
)
def test_what_makes_no_sense_is_told_by_its_row_and_changes_nothing(
    line: str, said: str, tmp_path: Path
) -> None:
    made = corrections.applied(ROWS, read(tmp_path, line))
    assert (made.rows, made.changes) == (ROWS, ())
    ((key, reason),) = [(one.key, one.reason) for one in made.rejections]
    assert (key, reason) == ("corrections.csv row 2", said)


@pytest.mark.parametrize("data", [b"\xff\xfe", b'"', b"a;b\n1;2\n"])
def test_a_file_that_is_no_table_is_told(data: bytes, tmp_path: Path) -> None:
    (tmp_path / "corrections.csv").write_bytes(data)
    (rejection,) = corrections.read(Store(str(tmp_path))).rejections
    assert rejection.key == "corrections.csv"


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            ",5-1-0,,width_m,18;5,",
            "value is '18;5', no number: write width_m in metres",
        ),
        (',5-1-0,,width_m,"18,5",', "with a decimal point, as 18.5"),
        (
            ",5-1-0,,width_m,500,",
            "value is '500', but width_m is from 1 to 400, in metres",
        ),
        (",5-1-0,,order,,", "value is empty: write order as a rank in its ring"),
        ("5_1.png,,,key,five,", "write key as block-lot, as 993-9"),
        (",,,key,5-3,", "photo is empty: write of which photo key tells"),
        ("5_1.png,,,mood,12,", "what is 'mood': write key, placard, target"),
    ],
)
def test_a_bad_correction_tells_its_column_and_the_remedy(
    line: str, said: str, tmp_path: Path
) -> None:
    (rejection,) = read(tmp_path, line).rejections
    assert said in rejection.detail


def test_a_table_parted_by_semicolons_corrects_alike(tmp_path: Path) -> None:
    line = ",5-2-0,,width_m,6.1,"
    by_commas = read(tmp_path, line).given
    (tmp_path / "corrections.csv").write_text(f"{HEAD}{line}\n".replace(",", ";"))
    assert corrections.read(Store(str(tmp_path))).given == by_commas


@pytest.mark.parametrize("data", [b"\xff\xfe", b"photo,width\na.jpg,6\n"])
def test_corrections_that_cannot_be_read_stop_a_build(
    data: bytes, tmp_path: Path
) -> None:
    store = Store(str(tmp_path))
    front_row = manifest.row_of("5_1.png", front(1, 0), root="", credit="")
    manifest.write(store, [front_row])
    (tmp_path / "corrections.csv").write_bytes(data)
    with pytest.raises(Unusable, match=r"corrections.csv .*mend the file"):
        corrected(store, source.found(store))


@pytest.mark.parametrize("what", ["width_m", "order"])
def test_a_front_that_is_none_tells_those_of_its_lot(what: str, tmp_path: Path) -> None:
    """A wall made round a corner has a name in the model, and no row."""
    given = read(tmp_path, f",5-4-0,,{what},6,", f",5-44-0,,{what},6,")
    lot, nowhere = corrections.applied(ROWS, given).rejections
    assert "its lot has 5-4-1 in manifest.csv" in lot.detail
    assert "no lot has it" in nowhere.detail


def test_lines_of_json_say_the_same_as_a_table(tmp_path: Path) -> None:
    one = {"what": "width_m", "front_id": "5-2-0", "value": 6.1}
    (tmp_path / "corrections.jsonl").write_text(f"{json.dumps(one)}\n\n")
    by_lines = corrections.applied(ROWS, corrections.read(Store(str(tmp_path)))).rows
    (tmp_path / "corrections.jsonl").unlink()
    assert (
        corrections.applied(ROWS, read(tmp_path, ",5-2-0,,width_m,6.1,")).rows
        == by_lines
    )


GOOD = b'{"what": "width_m", "front_id": "5-2-0", "value": 6.1}'


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (b'{"what": "key",', "is no JSON from letter 17 on"),
        (b"5_1.png,,,key,5-3,", "is no JSON from letter 2 on"),
        (b'{"note": "caf\xe9"}', "is not UTF-8"),
        (b"[" * 200_000, "is nested too deep"),
        (b"[1]", "is no object"),
        (b"9" * 5000, "has a number that is too long"),
        (b'{"what": "key", "photo": "\\ud800", "value": "5-3"}', "photo has a letter"),
        (b'{"value": 6.1}', "what is missing"),
        (b'{"what": "key", "value": null}', "value is missing"),
        (b'{"what": "key", "value": {}}', "value is '{}', neither words nor a number"),
    ],
)
def test_a_bad_line_is_told_by_its_number_and_harms_no_other(
    line: bytes, said: str, tmp_path: Path
) -> None:
    late = GOOD.replace(b"5-2-0", b"5-3-0")
    data = b"\xef\xbb\xbf" + b"\r\n".join([GOOD, line, b"", late])
    (tmp_path / "corrections.jsonl").write_bytes(data)
    found = corrections.read(Store(str(tmp_path)))
    assert [one.subject for one in found.given] == ["5-2-0", "5-3-0"]
    (rejection,) = found.rejections
    assert rejection.key == "corrections.jsonl row 2"
    assert rejection.detail.startswith(said)


@pytest.mark.parametrize("letter", "\u2028\u2029\x85")
def test_what_ends_lines_elsewhere_ends_none_here(letter: str, tmp_path: Path) -> None:
    noted = json.loads(GOOD) | {"note": f"an{letter}atlas"}
    text = json.dumps(noted, ensure_ascii=False) + "\n" + GOOD.decode()
    (tmp_path / "corrections.jsonl").write_text(text.replace("5-2", "5-4", 1))
    found = corrections.read(Store(str(tmp_path)))
    assert not found.rejections
    assert [one.note for one in found.given] == [f"an{letter}atlas", ""]


def test_a_build_obeys_and_does_again_only_the_block(tmp_path: Path) -> None:
    city = painted.write_city(tmp_path)
    first = built(city)
    before = tree(city)
    building = manifest.read(Store(str(city))).rows[0].front
    assert building is not None
    named = f"{building.block}-{building.lot}"
    (city / "corrections.csv").write_text(f"{HEAD},,{named},height_m,31.5,\n")
    report = built(city)
    assert report.run != first.run
    high = {b["id"]: b["height_m"] for b in told_buildings(city / "site")}
    assert high[named] == 31.5
    fresh = tree(city).keys() - before.keys()
    stages = {name.split("/")[1] for name in fresh if name.startswith("artifacts/")}
    assert stages == {"block"}
    assert len(artifacts(city, "block")) == report.blocks + 1
    (city / "corrections.csv").unlink()
    assert built(city).run == first.run


class Looked(Row):
    """A row that counts how often anybody looks at it, or copies it."""

    looks = 0

    def __getattribute__(self, name: str) -> Any:
        if name in ("front", "photo"):
            Looked.looks += 1
        return super().__getattribute__(name)


def looks(folder: Path, lots: int) -> int:
    """Correct every lot of a street in three ways, and count the looks at its rows."""
    rows = [
        Looked(n, "/photos", f"5_{n}.png", front(n, 0), "", {}) for n in range(lots)
    ]
    rows = [replace(r, front=replace(r.front, ring=r.number // 5)) for r in rows]
    lines = [f",5-{n}-0,,width_m,6.1," for n in range(lots)]
    lines += [f"5_{n}.png,,,key,5-{lots - 1 - n}," for n in range(lots)]
    lines += [f",5-{n}-0,,order,2.5," for n in range(lots)]
    lines += [f",5-{n}-9,,width_m,6.1," for n in range(lots)]
    given = read(folder, *lines)
    Looked.looks = 0
    made = corrections.applied(rows, given)
    assert len(made.changes) == 3 * lots
    assert len(made.rejections) == lots
    return Looked.looks


def test_twice_the_rows_and_corrections_cost_twice_the_work(tmp_path: Path) -> None:
    assert looks(tmp_path, 200) < 2.2 * looks(tmp_path, 100)
