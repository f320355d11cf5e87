import pytest

from pipelines.index.title import LONGEST, cleaned, of_folder

HOSTILE = [
    "<script>alert(1)</script>",
    "two\nlines\r\nand\ttabs",
    "x" * 10_000,
    "word " * 10_000,
    "bell\x07 nought\0 escape\x1b[31m",
    "turned \u202e round",
    "half \udcff a letter",
    " \u00a0 blank \u2028 ",
    "Stra\u00dfe \u200c \u4e2d\u592e",
    "",
]


@pytest.mark.parametrize("written", HOSTILE)
def test_a_title_is_one_short_line_that_can_be_seen(written: str) -> None:
    title = cleaned(written)
    assert len(title) <= LONGEST
    assert title == title.strip()
    assert title.replace("\u200c", "").isprintable()
    title.encode()


@pytest.mark.parametrize("written", HOSTILE)
def test_a_title_that_was_cleaned_is_clean(written: str) -> None:
    assert cleaned(cleaned(written)) == cleaned(written)


def test_a_decent_title_stays_as_it_is() -> None:
    for written in ("A painted neighbourhood", "Midtown, 1940 & <after>", "\u0130zmir"):
        assert cleaned(written) == written


def test_a_title_that_was_cut_says_so() -> None:
    assert cleaned("x" * 101) == "x" * 99 + "\u2026"
    assert cleaned("x" * 100) == "x" * 100


@pytest.mark.parametrize(
    ("name", "title"),
    [
        ("demo-city", "Demo city"),
        ("NYC_1940-45", "NYC 1940 45"),
        ("--", "A city"),
        ("", "A city"),
    ],
)
def test_a_folder_s_name_makes_a_title(name: str, title: str) -> None:
    assert of_folder(name) == title
