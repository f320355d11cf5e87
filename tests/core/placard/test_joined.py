"""What several looks say is joined with a list's keys, and never beyond them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nostalgin_core.placard import misread, pairs
from nostalgin_core.placard.joined import Look, around, joined, known

Key = tuple[str, str]
FEW = settings(deadline=None, max_examples=20)
KEYS = st.tuples(st.integers(10, 99_999), st.integers(1, 9_999)).map(
    lambda key: (str(key[0]), str(key[1]))
)


def looks(*lines: str) -> list[Look]:
    """One look a line; pieces are parted by bars."""
    return [Look((tuple(line.split("/")),)) for line in lines]


def decoys(key: Key, *, seed: int = 3, count: int = 40) -> set[Key]:
    near = sorted(around(key) - {key})
    rng = np.random.default_rng(seed)
    chosen = rng.choice(len(near), min(count, len(near)), replace=False)
    return {near[one] for one in chosen}


@FEW
@given(key=KEYS, letter=st.sampled_from("MXKR"), seed=st.integers(0, 99))
def test_a_board_read_alike_twice_is_joined_among_decoys_one_figure_away(
    key: Key, letter: str, seed: int
) -> None:
    # B and Q may be an eight and a nought, which a key one figure longer would have.
    text = f"{key[0]} -{key[1]} {letter}"
    found = joined(looks(text, text), known({key, *decoys(key, seed=seed)}))
    assert found.key == key
    assert found.sure
    assert found.score > found.runner_up_score


@FEW
@given(key=KEYS)
def test_a_text_costs_nothing_as_its_own_key_and_something_as_any_other(
    key: Key,
) -> None:
    text = misread.cleaned(f"{key[0]}-{key[1]}M")
    assert misread.whole(text, key) == 0
    assert all(misread.whole(text, one) > 0 for one in decoys(key))


@FEW
@given(text=st.text("0123456789-MSB ", max_size=12), key=KEYS)
def test_costs_are_never_negative_and_a_half_never_costs_more_than_the_whole(
    text: str, key: Key
) -> None:
    assert 0 <= pairs.costs([text], [key])[0, 0] <= misread.whole(text, key)


@FEW
@given(key=KEYS)
def test_shares_of_the_two_best_never_exceed_one(key: Key) -> None:
    found = joined(looks(f"{key[0]}-{key[1]}"), known(decoys(key)))
    assert 0 <= found.runner_up_score <= found.score
    assert found.score + found.runner_up_score <= 1 + 1e-9


def test_the_order_of_looks_does_not_matter() -> None:
    some = looks("997/7", "997-17/M", "9977M", "997-17")
    keys = known({("997", "17"), ("997", "7")})
    first = joined(some, keys)
    again = joined(some[::-1], keys)
    assert (first.key, again.key) == (("997", "17"), ("997", "17"))
    assert first.score == pytest.approx(again.score)


def test_a_one_that_ran_into_the_dash_is_found_where_one_list_alone_has_it() -> None:
    said = looks("997/7")
    alone = joined(said, known({("997", "17"), ("995", "2")}))
    both = joined(said, known({("997", "17"), ("997", "7")}))
    assert alone.key == ("997", "17")
    assert both.key == ("997", "7")
    assert not both.sure


def test_a_board_that_is_off_the_list_is_joined_with_nothing() -> None:
    found = joined(looks("1254 - 7 M", "1254-7M"), known({("993", "8")}))
    assert not found.sure
    assert found.literal == ("1254", "7")


def test_a_board_off_the_list_is_not_bent_to_a_key_one_figure_away() -> None:
    found = joined(looks("994-12M", "994-12M"), known({("997", "12")}))
    assert found.key == ("994", "12")
    assert not found.listed
    assert not found.sure


@pytest.mark.parametrize("text", ["996", "993/M", "-31M", "BAR", "NYC.gov/records", ""])
def test_half_a_board_is_never_enough(text: str) -> None:
    keys = known({("996", "31"), ("993", "8")})
    assert not joined(looks(text, text, text), keys).sure


def test_looks_that_contradict_each_other_are_not_sure() -> None:
    keys = known({("993", "8"), ("993", "3")})
    assert not joined(looks("993-8M", "993-3M"), keys).sure


def test_what_stands_beside_a_board_does_not_matter() -> None:
    keys = known({("996", "31"), ("996", "3")})
    found = joined(looks("996/-31M/BAR", "GARAGE/996/-31M"), keys)
    assert found.key == ("996", "31")
    assert found.sure


def test_without_a_list_a_board_that_is_read_alike_is_believed() -> None:
    found = joined(looks(*["993 -38 M"] * 4), None)
    assert found.key == ("993", "38")
    assert found.sure


def test_without_a_list_one_look_alone_is_not_believed() -> None:
    assert not joined(looks("997 7"), None).sure


def test_a_line_of_a_thousand_pieces_is_cut_short() -> None:
    wide = Look((tuple(str(n) for n in range(1000)),))
    assert not joined([wide], known({("993", "8")})).sure


def test_the_nearest_keys_are_those_that_a_search_of_all_finds() -> None:
    rng = np.random.default_rng(5)
    numbers = rng.integers([900, 1], [1000, 100], (300, 2))
    keys = {(str(block), str(lot)) for block, lot in numbers}
    for text in ("993-38M", "936 -1M", "99 - 17", "S96-12"):
        found = known(keys).near([text])
        wanted = misread.figures(text)
        once = {wanted, *misread.slips(wanted)}
        by_hand = {key for key in keys if "".join(key) in once}
        assert by_hand <= found


@pytest.mark.parametrize("key", [("12-A", "8"), ("1-2", "8"), ("993", "8-9")])
def test_a_block_or_a_lot_may_have_a_dash_in_it(key: Key) -> None:
    text = f"{key[0]} - {key[1]} M"
    bare = misread.cleaned(text.replace(" ", ""))
    assert pairs.costs([bare], [key])[0, 0] == 0
    found = joined(looks(text, text), known({key, *decoys(("993", "8"))}))
    assert found.key in (key, None)
    assert not found.sure or found.key == key
