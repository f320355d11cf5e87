import pytest

from pipelines.index.comma import NoTable, blank, parsed, written

NAMES = ["photo", "remark"]
ROWS = [{"photo": "a.jpg", "remark": "torn"}, {"photo": "b.jpg", "remark": ""}]
TEXT = "photo,remark\na.jpg,torn\nb.jpg,\n"


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("mark", ["", "\ufeff"])
def test_neither_line_ends_nor_a_mark_at_the_start_matter(end: str, mark: str) -> None:
    assert parsed((mark + TEXT.replace("\n", end)).encode()) == (NAMES, ROWS)


@pytest.mark.parametrize(
    "name", ["a\rb", "a\nb", "a\r\nb", 'a"b', "a,b", " a ", "=1+1", "\x1bb", "é"]
)
def test_what_was_written_is_read_back(name: str) -> None:
    rows = [{"photo": name, "remark": name}, *ROWS]
    assert parsed(written(NAMES, rows).encode()) == (NAMES, rows)


def test_an_empty_line_is_a_row_in_which_nothing_is_written() -> None:
    _, rows = parsed(b"photo,remark\na.jpg,torn\n\n,\nb.jpg,\n")
    assert [blank(row) for row in rows] == [False, True, True, False]


def test_what_stands_beyond_the_last_column_is_kept_apart() -> None:
    _, (row,) = parsed(b"photo\na.jpg,x\n")
    assert row == {"photo": "a.jpg", None: ["x"]}


@pytest.mark.parametrize(
    ("data", "remedy"),
    [
        (TEXT.encode("utf-16"), "save it as CSV in UTF-8"),
        ("photo\né".encode("latin-1"), "save it as CSV in UTF-8"),
        (b'photo\n"a', "save it anew"),
        (b"photo;remark\na.jpg;torn\n", "save it with commas"),
        (b"photo,lot,photo\na,1,b\n", "'photo': rename or delete"),
    ],
)
def test_what_is_no_table_is_refused_with_the_remedy(data: bytes, remedy: str) -> None:
    with pytest.raises(NoTable, match=remedy):
        parsed(data)
