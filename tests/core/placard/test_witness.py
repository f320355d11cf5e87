"""Three witnesses are heard, and none outvotes another in silence."""

import itertools

import pytest

from nostalgin_core.placard.joined import Joined
from nostalgin_core.placard.witness import VERDICTS, judge

HERE, THERE = ("993", "8"), ("993", "3")


def board(key: tuple[str, str] | None, score: float = 0.99, **told: object) -> Joined:
    return Joined(key, score, text="993-8M", cost=0.0, **told)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "listed", "seen", "verdict", "key"),
    [
        (HERE, [HERE], None, "agreed", HERE),
        (HERE, [HERE], board(HERE), "agreed", HERE),
        (None, [HERE], board(HERE), "agreed", HERE),
        (HERE, [], None, "name", HERE),
        (None, [HERE], None, "list", HERE),
        (None, [], board(HERE), "board", HERE),
        (HERE, [], board(THERE), "contradicted", HERE),
        (HERE, [HERE], board(THERE), "contradicted", HERE),
        (HERE, [THERE], None, "contradicted", THERE),
        (HERE, [THERE, HERE], None, "agreed", THERE),
        (None, [], board(HERE, 0.6), "unsure", None),
        (HERE, [], board(THERE, 0.6), "name", HERE),
        (None, [], board(THERE, listed=False), "unsure", None),
        (None, [], None, "silent", None),
        (None, [], Joined(None), "silent", None),
    ],
)
def test_each_verdict_follows_from_who_says_what(
    name: tuple[str, str] | None,
    listed: list[tuple[str, str]],
    seen: Joined | None,
    verdict: str,
    key: tuple[str, str] | None,
) -> None:
    found = judge(name, listed, seen)
    assert (found.verdict, found.key) == (verdict, key)


def test_a_contradiction_names_every_source() -> None:
    found = judge(HERE, [HERE], board(THERE))
    for words in ("its name says 993-8", "the list says 993-8", "board says 993-3"):
        assert words in found.remedy


def test_a_board_never_moves_what_a_name_or_a_list_says() -> None:
    witnesses = (None, HERE, THERE)
    for name, listed, seen in itertools.product(witnesses, witnesses, witnesses):
        rows = [listed] if listed else []
        alone = judge(name, rows, None)
        told = judge(name, rows, board(seen) if seen else None)
        assert told.verdict in VERDICTS
        if alone.key is not None:
            assert told.key == alone.key


def test_what_nothing_places_has_a_remedy() -> None:
    for seen in (None, Joined(None), board(HERE, 0.5), board(HERE, listed=False)):
        assert "list" in judge(None, [], seen).remedy
    assert "broken" in judge(None, [], None, why="broken file").remedy
