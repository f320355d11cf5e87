"""What a model says of rights: nothing that a watermark said is lost with it."""

import pytest

from nostalgin_core.model import Rights

MARKS = ("A.org/records", "B.org")


@pytest.mark.parametrize("credit", ["", "An archive"])
def test_what_a_watermark_said_is_said_wherever_credit_is(credit: str) -> None:
    rights = Rights(credit, watermarks=MARKS)
    for words in MARKS:
        assert words in rights.line
        assert words in rights.extras["credit"]


@pytest.mark.parametrize("credit", ["", "An archive"])
def test_a_watermark_adds_to_the_credit_and_takes_nothing_from_it(credit: str) -> None:
    bare, marked = Rights(credit), Rights(credit, watermarks=MARKS)
    assert marked.extras["credit"].startswith(bare.extras["credit"])
    assert {**marked.extras, "credit": ""} == {**bare.extras, "credit": ""}


def test_nobody_is_told_of_a_watermark_that_was_not_there() -> None:
    assert Rights("An archive").line == "An archive; licence: not stated"
    assert Rights().line == "credit not stated; licence: not stated"
