"""What is told to people can be read, however long the words of a list are."""

import io
import json

import pytest
from rich.console import Console

from pipelines.console.voice import MOST_LETTERS, Voice

LONG = "block 5, lot 1: " + "שָׁלוֹם רחוב " * 800 + "mend the street"


def test_a_line_of_ten_thousand_letters_keeps_its_name_and_its_remedy() -> None:
    heard = io.StringIO()
    Voice(Console(file=heard, width=10**6)).say("warning", LONG)
    line = heard.getvalue()
    assert line.startswith("block 5, lot 1:")
    assert line.endswith("mend the street\n")
    assert len(line) < MOST_LETTERS + 20


def test_a_line_of_usual_length_is_told_as_it_is() -> None:
    heard = io.StringIO()
    Voice(Console(file=heard, width=10**6)).say("done", "99 photos")
    assert heard.getvalue() == "99 photos\n"


def test_machines_are_told_all(capsys: pytest.CaptureFixture[str]) -> None:
    Voice(Console(), machine=True).say("warning", "", warning=LONG)
    assert json.loads(capsys.readouterr().out)["warning"] == LONG
