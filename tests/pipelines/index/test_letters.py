"""Lists in other encodings than UTF-8, from their bytes to the manifest."""

import codecs
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from pipelines.cli import app
from pipelines.index import manifest
from pipelines.index.letters import Garbled, utf8
from pipelines.store import Store
from tests.pipelines import painted

TABLE = """photo,block,lot,street,address,rights
Hôtel Müller.png,5,1,Rue Saint-Honoré,213,© Archiv für Straßen \u2013 Zürich
5_2.png,5,2,Rue Saint-Honoré,215,none
5_3.png,5,3,Rue de l\u2019Échaudé,7,none
"""
WESTERN = ("latin-1", "cp1252", "iso8859-15")


def indexed(folder: Path, data: bytes, *words: str) -> Result:
    photos = folder / "photos"
    photos.mkdir(parents=True)
    for name in ("Hôtel Müller.png", "5_2.png", "5_3.png"):
        (photos / name).write_bytes(painted.photo())
    (folder / "list.csv").write_bytes(data)
    asked = ["index", photos, "--catalogue", folder / "list.csv", "-o", folder / "city"]
    return CliRunner().invoke(app, [*map(str, asked), *words])


def told(folder: Path) -> list[tuple[str, str, str]]:
    """Give each front's photograph, street and the rights in it."""
    found = manifest.read(Store(str(folder / "city"))).rows
    return [
        (row.photo, row.front.street, row.cells["rights"]) for row in found if row.front
    ]


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> list[tuple[str, str, str]]:
    folder = tmp_path_factory.mktemp("plain")
    assert "is read as" not in indexed(folder, TABLE.encode()).output
    rows = told(folder)
    assert (
        "Hôtel Müller.png",
        "Rue Saint-Honoré",
        "© Archiv für Straßen \u2013 Zürich",
    ) in rows
    return rows


@pytest.mark.parametrize(
    ("data", "warned"),
    [
        (TABLE.encode("utf-8-sig"), False),
        (TABLE.encode("utf-16"), False),
        (codecs.BOM_UTF16_BE + TABLE.encode("utf-16-be"), False),
        (TABLE.encode("utf-32"), False),
        (TABLE.encode("utf-16-le"), True),
        (TABLE.encode("utf-16-be"), True),
        (TABLE.encode("cp1252"), True),
        (TABLE.replace("\n", "\r\n").encode("cp1252"), True),
    ],
)
def test_names_with_accents_are_the_same_in_every_encoding(
    data: bytes, plain: list[tuple[str, str, str]], *, warned: bool, tmp_path: Path
) -> None:
    result = indexed(tmp_path, data)
    assert result.exit_code == 0, result.output
    assert told(tmp_path) == plain
    assert result.output.count("read as") == warned


def test_a_guess_names_the_file_and_the_first_line_that_needed_it(
    tmp_path: Path,
) -> None:
    said = " ".join(indexed(tmp_path, TABLE.encode("cp1252")).output.split())
    assert "warning: list.csv: line 2 is no UTF-8: all is read as Windows-1252" in said
    assert "'Hôtel Müller.png,5," in said
    assert "--encoding" in said


def test_what_is_named_is_not_guessed(
    plain: list[tuple[str, str, str]], tmp_path: Path
) -> None:
    roman = indexed(tmp_path / "a", TABLE.encode("mac-roman"), "--encoding", "macroman")
    assert roman.exit_code == 0
    assert "read as" not in roman.output
    assert told(tmp_path / "a") == plain
    other = indexed(tmp_path / "b", TABLE.encode("cp1252"), "--encoding", "utf-8")
    assert other.exit_code == 1
    assert "is no utf-8" in other.output
    odd = indexed(tmp_path / "c", TABLE.encode(), "--encoding", "klingon")
    assert odd.exit_code == 1
    assert "no encoding 'klingon'" in odd.output


@pytest.mark.parametrize("encoding", WESTERN)
def test_western_letters_survive(encoding: str) -> None:
    text = "street\nÅngström, Ñuñoa, Čapek".replace("Č", "C")
    read, guessed = utf8(text.encode(encoding))
    assert read.decode() == text
    assert guessed.startswith("line 2 ")


def test_utf_8_is_left_as_it_is() -> None:
    for text in ("", "a,b\n", "Müller\n", "Łódź, Москва, 東京\n", "a\0b,c\n"):
        assert utf8(text.encode()) == (text.encode(), "")


@pytest.mark.parametrize(
    ("data", "said"),
    [
        ("Müller\n".encode() + "Müller\n".encode("cp1252"), "line 2 .* line 1 is"),
        (b"a\nCaf\x81\n", "line 2 is neither"),
        (b"\x89PNG\r\n\x1a\n\x00\x01\x02", "no text: read as cp1252, line 2"),
        (bytes(4096), "no text: read as utf-16-le"),
        ("Müller".encode("utf-16")[:-1], "is no utf-16"),
    ],
)
def test_what_is_damaged_or_no_text_is_refused_with_the_remedy(
    data: bytes, said: str
) -> None:
    with pytest.raises(Garbled, match=said) as problem:
        utf8(data)
    assert "save it as CSV in UTF-8" in str(problem.value)
