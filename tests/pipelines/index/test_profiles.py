"""What names and boards are like stands in a file; slips in it are told."""

import re
from collections.abc import Sequence
from pathlib import Path, PurePosixPath

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nostalgin_core.catalogue import from_file_name
from nostalgin_core.placard import Look
from pipelines.index import Ask, Heard, Nothing
from pipelines.index.index import Indexed, Question, index
from pipelines.index.manifest import read
from pipelines.index.profiles import USUAL, built_in, profile
from pipelines.store import Store

LAX = re.compile(r"(?:^|\D)(\d{1,5})\D{1,7}?(\d{1,4})[a-z]?$")
NAMES = [
    "nynyma_rec0040_1_00993_0008a.jpg",
    "b/993_8a.jpg",
    "993-08.png",
    "block 993 lot 8.tif",
    "bakery.jpg",
    "IMG_20231104_1200.jpg",
    "00993_0008A.jpg",
    "c\\00993_0008.jpg",
    "00000_0000.jpg",
    "\u0660\u0660\u0669\u0669\u0663_0008.png",
    "\udce9_993-8.jpg",
    " 993_8 .jpg",
    "993_8\n.jpg",
    "Stra\u00dfe 993 \u212a 8\u212a.jpg",
    "",
    ".jpg",
]
SOME = st.text("0123459_-ab Aß.\u0663/", max_size=24)
OWN = r"""
[names]
patterns = ['^L(?P<lot>\d+)B(?P<block>\d+)$']

[board]
present = true
pattern = 'LOT (?P<lot>[0-9]+) BLK (?P<block>[0-9]+)'
"""


def slow(name: str) -> tuple[str, str] | None:
    """Read as before there were profiles."""
    found = LAX.search(PurePosixPath(name).stem.strip().casefold())
    return (str(int(found[1])), str(int(found[2]))) if found else None


def own(tmp_path: Path, text: str | bytes) -> str:
    file = tmp_path / "own.toml"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return str(file)


@pytest.mark.parametrize("name", NAMES)
def test_the_usual_profile_reads_names_as_before_there_were_any(name: str) -> None:
    naming = profile(USUAL).naming
    assert naming.told(name) == from_file_name(name)
    assert naming.guessed(name) == (from_file_name(name) or slow(name))


@settings(deadline=None, max_examples=300)
@given(name=SOME | st.from_regex(r"[a-z]?_?\d{3,5}[_-]\d{2,4}[a-zA-Z]?\Z"))
def test_the_usual_profile_reads_any_name_as_before(name: str) -> None:
    naming = profile(USUAL).naming
    assert naming.told(name) == from_file_name(name)
    assert naming.guessed(name) == (from_file_name(name) or slow(name))


def test_two_profiles_come_with_the_program() -> None:
    assert built_in() == ["nyc-1940", "plain"]
    assert profile(USUAL).boarded
    assert not profile("plain").boarded


class Boards:
    """Says the same of every board, and remembers whom it was asked about."""

    def __init__(self, text: str = "") -> None:
        self.text, self.asked = text, list[str]()

    def __call__(self, root: str, names: Sequence[str]) -> dict[str, Heard]:
        assert Path(root).is_dir()
        self.asked += names
        looks = (Look(((self.text,),)),) * 4
        return {name: Heard(name[:6], "segmented", looks) for name in names}


def indexed(
    tmp_path: Path, names: Sequence[str], asked: str, ask: Ask | None = None
) -> Indexed:
    folder = tmp_path / "photos"
    folder.mkdir()
    for name in names:
        (folder / name).write_bytes(b"no picture is read here")
    city = str(tmp_path / "city")
    return index(folder, None, city, Question(archive=profile(asked)), ask=ask)


def lots(tmp_path: Path) -> list[tuple[str, str]]:
    rows = read(Store(str(tmp_path / "city"))).rows
    return [(one.front.block, one.front.lot) for one in rows if one.front]


def test_plain_photographs_stand_in_the_order_of_their_names(tmp_path: Path) -> None:
    boards = Boards("993-8M")
    names = ["x_00993_0008.jpg", "x_00993_0010.jpg", "x_00996_0001.jpg"]
    indexed(tmp_path, names, "plain", Ask(boards))
    assert not boards.asked
    assert lots(tmp_path) == [("photos", "1"), ("photos", "2"), ("photos", "3")]


def test_boards_of_all_are_refused_where_there_are_none(tmp_path: Path) -> None:
    with pytest.raises(Nothing, match="--boards"):
        indexed(tmp_path, ["a.jpg"], "plain", Ask(Boards(), "all"))


def test_a_profile_of_ones_own_reads_names_and_boards(tmp_path: Path) -> None:
    boards = Boards("LOT 31 BLK 996")
    asked = own(tmp_path, OWN)
    indexed(tmp_path, ["L8B993.jpg", "00997_0001.jpg"], asked, Ask(boards))
    assert boards.asked == ["00997_0001.jpg"]
    assert sorted(lots(tmp_path)) == [("993", "8"), ("996", "31")]


def test_a_board_that_is_not_as_the_profile_has_it_places_nothing(
    tmp_path: Path,
) -> None:
    asked = own(tmp_path, OWN)
    made = indexed(tmp_path, ["a.jpg"], asked, Ask(Boards("996-31M")))
    assert made.witnesses == {"silent": 1}


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("[name]\n", "name: not a key"),
        ("[names]\npattern = []\n", "names.pattern: not a key"),
        ("[names]\npatterns = 'x'\n", "names.patterns: not a list"),
        ("[names]\npatterns = [3]\n", "names.patterns.number 1: not a text"),
        ("names = 3\n", "names: not a table"),
        ("[board]\npresent = 'yes'\n", "board.present: neither true nor false"),
        ("[board]\npattern = '(?P<block>.)(?P<lot>.)'\n", "write present = true"),
        ("[names]\npatterns = ['(']\n", "names.patterns.number 1: no pattern: missing"),
        ("[names]\npatterns = ['(?P<block>.)']\n", r"write (?P<lot>...)"),
        ("[names]\npatterns = ['(?P<block>.)(?P<lot>.)(?P<x>.)']\n", "group x is not"),
        ("[names]\npatterns = ['(?P<block>.)\\1']\n", "no pattern: invalid esc"),
        ("[names]\npatterns = ['((a{99}){99}){99}']\n", "no pattern: "),
        (f"[names]\npatterns = ['{'a' * 2000}']\n", "longer than 1,000 letters"),
        (f"[names]\npatterns = {['(?P<block>.)(?P<lot>.)'] * 21}\n", "join some by |"),
        (f"{'k' * 9000} = 3\n", "k...: not a key"),
        ("patterns = [\n", "no TOML: "),
        (f"a = {'[' * 20_000}", "no TOML: "),
        (f"a = {'9' * 20_000}", "no TOML: "),
        (b"\xff\xfe[\x00n\x00", "save it as UTF-8"),
        (b" " * 10_000_000, "Larger than the 64,000 bytes"),
    ],
)
def test_slips_in_a_profile_are_told_with_file_key_and_remedy(
    tmp_path: Path, text: str | bytes, told: str
) -> None:
    with pytest.raises(Nothing) as problem:
        profile(own(tmp_path, text))
    assert told in str(problem.value)
    assert "own.toml: " in str(problem.value)
    assert len(str(problem.value)) < 600


@pytest.mark.parametrize("asked", ["nyc-1941", ".", "a\0b", ""])
def test_a_profile_that_is_not_there_is_told_beside_those_that_are(asked: str) -> None:
    with pytest.raises(Nothing, match="one of nyc-1940, plain"):
        profile(asked)
