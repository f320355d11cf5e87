import csv
import io

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from pipelines.index.comma import NoTable, blank, parsed, written

NAMES = ["photo", "remark"]
ROWS = [{"photo": "a.jpg", "remark": "torn"}, {"photo": "b.jpg", "remark": ""}]
TEXT = "photo,remark\na.jpg,torn\nb.jpg,\n"


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("mark", ["", "\ufeff"])
def test_neither_line_ends_nor_a_mark_at_the_start_matter(end: str, mark: str) -> None:
    names, rows = parsed((mark + TEXT.replace("\n", end)).encode())
    assert (names, list(rows)) == (NAMES, ROWS)


@pytest.mark.parametrize("sign", [";", "\t"])
@pytest.mark.parametrize("mark", ["", "\ufeff"])
def test_semicolons_and_tabs_part_cells_as_commas_do(sign: str, mark: str) -> None:
    names, rows = parsed((mark + TEXT.replace(",", sign)).encode())
    assert (names, list(rows)) == (NAMES, ROWS)


def test_what_parts_cells_is_told_by_the_header_outside_its_quotes() -> None:
    """Decimal commas in rows, and commas in quoted names, part nothing."""
    data = b'"photo, ""its"", name";width_m\n5_1.jpg;18,5\n'
    names, rows = parsed(data)
    assert names == ['photo, "its", name', "width_m"]
    assert [list(row.values()) for row in rows] == [["5_1.jpg", "18,5"]]
    assert parsed(b'photo,"a;b;c"\n1,2\n')[0] == ["photo", "a;b;c"]


CELLS = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"))
RUN = st.text("'=+-@\t\r\n\uff1d\uff0b\uff0d\uff201.5e,\"x ", max_size=6)


@given(CELLS | RUN, CELLS | RUN)
@example("a\rb", "a\r\nb")
@example('a"b', "a,b")
@example("=cmd|' /C calc'!A0", "'=1+1")
@example("-73.98", "'-73.98")
def test_what_was_written_is_read_back(photo: str, remark: str) -> None:
    rows = [{"photo": photo, "remark": remark}, *ROWS]
    names, found = parsed(written(NAMES, rows).encode(), ours=True)
    assert (names, list(found)) == (NAMES, rows)


@given(RUN)
@example("=cmd|' /C calc'!A0")
@example("\t=1+1")
@example("@SUM(A1)")
@example("+1-1")
def test_no_cell_is_written_that_a_spreadsheet_would_run(cell: str) -> None:
    text = io.StringIO(written([cell], [{cell: cell}]), newline="")
    for (seen,) in csv.reader(text):
        assert not seen.startswith(("=", "@", "\t", "\r", "\n", "\uff1d", "\uff20"))
        assert seen[:1] not in {"+", "-"} or abs(float(seen)) >= 0


@pytest.mark.parametrize("number", ["-73.98", "+1", "-1e-7", "-.5", "40.75"])
def test_a_number_is_written_as_it_is(number: str) -> None:
    assert written(["a"], [{"a": number}]) == f"a\n{number}\n"


def test_a_cell_of_ten_million_letters_is_read() -> None:
    _, rows = parsed(b"photo,remark\na.jpg," + b"x" * 10_000_000 + b"\nb.jpg,\n")
    assert [len(row["remark"]) for row in rows] == [10_000_000, 0]


def test_a_quote_that_is_not_closed_is_told_by_its_row() -> None:
    with pytest.raises(NoTable, match="row 3"):
        parsed(b'photo\na.jpg\n"b.jpg\n' + b"c.jpg\n" * 100_000)


def test_an_empty_line_is_a_row_in_which_nothing_is_written() -> None:
    _, rows = parsed(b"photo,remark\na.jpg,torn\n\n,\nb.jpg,\n")
    assert [blank(row) for row in rows] == [False, True, True, False]


def test_what_stands_beyond_the_last_column_is_kept_apart() -> None:
    _, (row,) = parsed(b"photo\na.jpg,x\n")
    assert row == {"photo": "a.jpg", None: ["x"]}


def test_words_that_rows_share_are_held_once() -> None:
    _, rows = parsed(b"photo,street\n" + b"a.jpg,West 40 Street\n" * 3)
    assert len({id(row["street"]) for row in rows}) == 1
    assert [*rows[1:]] == [rows[1], rows[2]] == [*rows][:2]


@pytest.mark.parametrize(
    ("data", "remedy"),
    [
        (TEXT.encode("utf-16"), "save it as CSV in UTF-8"),
        ("photo\né".encode("latin-1"), "save it as CSV in UTF-8"),
        (b'photo\n"a', "mend its quotes"),
        (b"photo|remark\na.jpg|torn\n", "save it with commas"),
        (b"photo,lot,photo\na,1,b\n", "'photo': rename or delete"),
    ],
)
def test_what_is_no_table_is_refused_with_the_remedy(data: bytes, remedy: str) -> None:
    with pytest.raises(NoTable, match=remedy):
        parsed(data)
