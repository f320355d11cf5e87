"""What names, list and boards say of each photograph, with boards that are made up."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest

from nostalgin_core import placard
from nostalgin_core.placard import Look
from pipelines.index import Ask, Heard, joining
from pipelines.index.index import index

LIST = """photo,block,lot,street,address
,993,8,Broadway,1435
,993,10,Broadway,1437
,996,31,Elm Street,5
listed.png,996,32,Elm Street,7
"""
PHOTOS = {
    "listed.png": "",
    "nyc_00993_0008.png": "",
    "nyc_00993_0010.png": "996-31M",  # its board contradicts its name
    "scan_1.png": "996-31M",
    "scan_2.png": "996-31M",  # two boards that read alike
    "scan_3.png": "1254-7M",  # of a block that the list does not have
    "scan_4.png": "99S-",
    "scan_5.png": "",  # no board
}


class Boards:
    """Says what is made up, and remembers whom it was asked about."""

    def __init__(self, told: Mapping[str, str]) -> None:
        self.told, self.asked = told, list[str]()

    def __call__(self, root: str, names: Sequence[str]) -> dict[str, Heard]:
        assert Path(root).is_dir()
        self.asked += names
        return {name: heard(name, self.told[name]) for name in names}


def heard(name: str, text: str) -> Heard:
    if name == "scan_6.png":
        return Heard(why="not a picture: it is a text; save a photo", spoiled=True)
    looks = (Look(((text,),)),) * 4 if text else ()
    return Heard(name[:6], "segmented" if text else "", looks, lambda: b"png")


def photos(folder: Path, names: Sequence[str]) -> Path:
    folder.mkdir()
    for name in names:
        (folder / name).write_bytes(b"no picture is read here")
    return folder


def rows(city: Path) -> dict[str, dict[str, Any]]:
    table = pq.read_table(city / "readings.parquet").to_pylist()
    return {row["photo"]: row for row in table}


def indexed(tmp_path: Path, which: Any) -> tuple[Boards, Path, Any]:
    folder = photos(tmp_path / "photos", [*PHOTOS, "scan_6.png"])
    (tmp_path / "list.csv").write_text(LIST)
    boards, city = Boards({**PHOTOS, "scan_6.png": ""}), tmp_path / "city"
    made = index(folder, tmp_path / "list.csv", str(city), ask=Ask(boards, which))
    return boards, city, made


def test_boards_are_asked_of_photos_alone_that_nothing_else_places(
    tmp_path: Path,
) -> None:
    boards, city, made = indexed(tmp_path, "silent")
    assert boards.asked == [f"scan_{n}.png" for n in range(1, 7)]
    verdicts = {photo: row["verdict"] for photo, row in rows(city).items()}
    assert verdicts == {
        "listed.png": "list",
        "nyc_00993_0008.png": "name",
        "nyc_00993_0010.png": "name",
        "scan_1.png": "board",
        "scan_2.png": "board",
        "scan_3.png": "unsure",
        "scan_4.png": "unsure",
        "scan_5.png": "silent",
        "scan_6.png": "silent",
    }
    assert made.witnesses == {
        "name": 2,
        "list": 1,
        "board": 2,
        "unsure": 2,
        "silent": 2,
    }
    assert (made.boards, len(made.without_front)) == (6, 4)


def test_a_contradiction_is_told_and_moves_nothing(tmp_path: Path) -> None:
    _, city, made = indexed(tmp_path, "all")
    row = rows(city)["nyc_00993_0010.png"]
    assert row["verdict"] == "contradicted"
    assert (row["joined_block"], row["joined_lot"]) == ("993", "10")
    assert (city / row["crop"]).read_bytes() == b"png"
    told = [one for one in made.warnings if "nyc_00993_0010.png" in one]
    assert "its name says 993-10" in told[0]
    assert "its board says 996-31" in told[0]


def test_every_photo_that_nothing_places_has_a_remedy_and_a_rejection(
    tmp_path: Path,
) -> None:
    _, city, made = indexed(tmp_path, "silent")
    told = {one.key: one.detail for one in made.rejections}
    for name, row in rows(city).items():
        if row["verdict"] in ("unsure", "silent"):
            assert "list" in row["remedy"] or name == "scan_6.png"
            assert row["joined_block"] == row["joined_lot"] == ""
            assert name in told
    assert "1254-7" in told["scan_3.png"]
    assert told["scan_6.png"].endswith("it is a text; save a photo")  # one remedy


def test_no_board_is_asked_where_none_is_wanted(tmp_path: Path) -> None:
    boards, city, _ = indexed(tmp_path, "none")
    assert not boards.asked
    assert rows(city)["scan_1.png"]["verdict"] == "silent"


@pytest.mark.parametrize("which", ["silent", "none"])
def test_without_a_list_boards_tell_what_names_do_not(
    tmp_path: Path, which: Any
) -> None:
    folder = photos(tmp_path / "photos", ["scan_1.png", "scan_5.png", "993-8.png"])
    boards, city = (
        Boards({"scan_1.png": "996-31M", "scan_5.png": ""}),
        tmp_path / "city",
    )
    index(folder, None, str(city), ask=Ask(boards, which))
    put = {p: (r["verdict"], r["joined_block"]) for p, r in rows(city).items()}
    assert put["993-8.png"] == ("name", "993")
    assert put["scan_5.png"] == ("silent", "")
    wanted = ("board", "996") if which == "silent" else ("silent", "")
    assert put["scan_1.png"] == wanted


def test_the_table_is_the_same_whatever_the_order_of_hearing(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
    _, first, _ = indexed(tmp_path / "a", "all")
    _, second, _ = indexed(tmp_path / "b", "all")
    one, other = (c / "readings.parquet" for c in (first, second))
    assert one.read_bytes() == other.read_bytes()


def test_boards_are_joined_alike_by_one_process_and_by_two(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(joining, "MUCH", 2)
    monkeypatch.setattr(joining, "AT_ONCE", 3)
    keys = placard.known({(str(b), str(n)) for b in range(90, 110) for n in range(40)})
    boards = {f"{b}.jpg": [Look(((f"{b}", f"-{b % 40}"),))] for b in range(90, 110)}
    boards |= {"none.jpg": [Look((("x",),))], "slip.jpg": [Look((("97-l7",),))]}
    for some in (keys, None):
        alone = joining.joined(boards, some)
        assert joining.joined(boards, some, processes=2) == alone
        assert list(alone) == list(boards)
