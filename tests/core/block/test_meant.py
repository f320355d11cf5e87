"""A street takes back what a photograph alone took for its building."""

import pytest

from nostalgin_core.block.meant import CALLED, meant, stated
from tests.core.listed import seen

SCORES = (0.03, 0.4, 0.6, 0.97)


@pytest.mark.parametrize("score", SCORES)
def test_a_street_that_agrees_or_says_nothing_changes_nothing(score: float) -> None:
    assert stated(score, None) == score
    assert stated(score, score) == score
    assert stated(score, 0.99) == score
    odds = score / (1 - score) / 5  # it is not that sure
    assert stated(score, odds / (1 + odds)) == score


@pytest.mark.parametrize("score", SCORES[1:])
def test_the_more_a_street_contradicts_the_less_is_stated(score: float) -> None:
    told = [stated(score, street) for street in (0.3, 0.1, 0.03)]
    assert told == sorted(told, reverse=True)
    assert told[-1] < score


def test_no_street_takes_back_what_a_hand_has_told() -> None:
    assert stated(1.0, 0.0) == 1.0
    assert stated(0.0, 1.0) == 0.0


def test_a_second_facade_that_is_a_neighbours_is_no_target() -> None:
    first, second = seen("p", 0, target_score=0.9), seen("p", 1, target_score=0.6)
    own = {("p", 0): 0.9, ("p", 1): 0.01}
    one, other = meant([first, second], own)
    assert one == first
    assert not other.target
    assert other.target_score < CALLED
    corner = {("p", 0): 0.9, ("p", 1): 0.6}
    assert meant([first, second], corner)[1] == second


@pytest.mark.parametrize("order", [1, -1])
def test_a_photograph_keeps_its_surest_target(order: int) -> None:
    filed_wrong = [seen("p", 0, target_score=0.7), seen("p", 1, target_score=0.6)]
    beside = seen("p", 2, target=False, target_score=0.45)
    own = {("p", 0): 0.001, ("p", 1): 0.002, ("p", 2): 0.5}
    told = meant([*filed_wrong, beside][::order], own)
    assert [one.facade for one in told if one.target] == [0]
    assert meant([], own) == ()


def test_photographs_that_a_street_does_not_know_stay_as_they_are() -> None:
    alone = (seen("p", 0), seen("q", 3, target_score=0.55))
    assert meant(alone, {}) == alone
