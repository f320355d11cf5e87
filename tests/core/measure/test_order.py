import pytest
from hypothesis import given
from hypothesis import strategies as st

from nostalgin_core.measure.order import longest, opposite, orders, sides
from nostalgin_core.records import Front
from tests.core import listed


def front(
    lot: str, rank: int, street: str, *, block: str = "5", ring: int = 0
) -> Front:
    return listed.front(lot, rank=rank, street=street, block=block, ring=ring)


def walked(
    *lots: tuple[str, int], block: str = "5", street: str = "Elm"
) -> list[Front]:
    return [front(lot, rank, street, block=block) for rank, (lot, _) in enumerate(lots)]


def told(
    *lots: tuple[str, int], block: str = "5", street: str = "Elm"
) -> dict[tuple[str, str], list[str]]:
    return {(block, lot): [f"{number} {street}"] for lot, number in lots}


UP = (("a", 1), ("b", 3), ("c", 5), ("d", 9))


@pytest.mark.parametrize("lots", [UP, UP[::-1]])
def test_lots_that_rise_or_fall_are_all_right(
    lots: tuple[tuple[str, int], ...],
) -> None:
    (one,) = orders(walked(*lots), told(*lots))
    assert (one.lots, one.right, one.wrong) == (4, 4, ())


def test_a_lot_that_goes_back_is_named() -> None:
    lots = (UP[0], UP[2], UP[3], UP[1])
    (one,) = orders(walked(*lots), told(*lots))
    assert (one.lots, one.right, one.wrong) == (4, 3, ("b",))


def test_a_lot_without_a_number_counts_for_nothing() -> None:
    fronts = [*walked(*UP), front("e", 4, "Elm"), front("f", 5, "Oak")]
    known = told(*UP) | {("5", "e"): ["Elm"], ("5", "f"): ["7 Elm"]}
    (one,) = orders(fronts, known)
    assert (one.lots, one.right, one.unnumbered) == (4, 4, 2)


def test_two_rings_part_a_street_and_do_not_mix_its_numbers() -> None:
    lots = (("a", 1), ("b", 3), ("c", 9), ("d", 11))
    where = {"a": 1, "b": 1, "c": 0, "d": 0}
    fronts = [front(lot, n, "Elm", ring=where[lot]) for n, (lot, _) in enumerate(lots)]
    (one,) = orders(fronts, told(*lots))
    assert (one.rings, one.right) == (2, 4)
    mixed = [front(lot, n, "Elm", ring=n % 2) for n, (lot, _) in enumerate(lots)]
    (one,) = orders(mixed, told(*lots))
    assert one.right < 4


def test_the_sides_of_a_street_run_opposite() -> None:
    even = (("e", 2), ("f", 4), ("g", 6))
    known = told(*UP) | told(*even, block="6")
    right = [*walked(*UP), *walked(*even[::-1], block="6")]
    mirrored = [*walked(*UP), *walked(*even, block="6")]
    assert opposite(sides(right, known)) == (1, 1)
    assert opposite(sides(mirrored, known)) == (0, 1)


@given(st.lists(st.integers(0, 9), max_size=8))
def test_the_longest_run_is_as_long_as_trying_all_finds(numbers: list[int]) -> None:
    kept = [numbers[place] for place in longest(numbers)]
    assert kept == sorted(kept)
    most = 0
    for chosen in range(2 ** len(numbers)):
        some = [one for n, one in enumerate(numbers) if chosen >> n & 1]
        most = max(most, len(some) if some == sorted(some) else 0)
    assert len(kept) == most
