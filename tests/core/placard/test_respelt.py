"""Boards of another archive are read by its own pattern, with the same caution."""

import pytest

from nostalgin_core.placard import Look, joined, known, respelt

OTHER = r"LOT ?(?P<lot>[0-9]+) BLK ?(?P<block>[0-9]+)"


def looks(*lines: str) -> list[Look]:
    return [Look((tuple(line.split("/")),)) for line in lines]


def test_groups_of_a_board_may_stand_in_any_order() -> None:
    read = respelt(looks("Lot 5/Blk. 993", "GARAGE/LOT5/BLK 993"), OTHER)
    found = joined(read, known({("993", "5"), ("5", "993"), ("993", "6")}))
    assert found.key == ("993", "5")
    assert found.sure


def test_a_line_that_the_pattern_is_not_found_in_is_of_no_board() -> None:
    assert not joined(respelt(looks("993-5 M", "993-5 M"), OTHER), None).sure
    assert respelt(looks("993-5 M"), OTHER) == (Look(()),)


def test_a_board_of_its_own_is_still_never_joined_with_a_key_one_figure_away() -> None:
    read = respelt(looks("LOT 5 BLK 993"), OTHER)
    assert not joined(read, known({("998", "5"), ("993", "6")})).sure


def test_a_pattern_without_a_lot_is_refused() -> None:
    with pytest.raises(ValueError, match="no group lot"):
        respelt(looks("BLK 993"), "BLK (?P<block>[0-9]+)")
