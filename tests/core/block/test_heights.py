import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nostalgin_core.block import heights
from nostalgin_core.block.heights import HEIGHTS_M, STOREY_M, Shown, Told
from nostalgin_core.storeys import COUNTS


def rows(n: float, score: float = 0.4) -> tuple[float, ...]:
    """Score counts as an elevation of n storeys does."""
    return tuple(score * np.exp(-0.5 * (np.log(COUNTS / n) / 0.05) ** 2))


def told(
    height_m: float,
    n: float | None = None,
    *,
    assumed: bool = False,
    width_m: float = 8.0,
) -> Told:
    aspect = width_m / height_m
    storeys = () if n is None else rows(n)
    return Told(width_m, assumed, Shown(("p", 0), aspect, 0.02 * aspect, 0.9, storeys))


def known(*some: Told) -> heights.Height:
    found = heights.height(some)
    assert found is not None
    return found


@given(st.floats(6.0, 80.0))
def test_witnesses_that_agree_are_believed(height_m: float) -> None:
    one = known(told(height_m, height_m / STOREY_M))
    assert one.height_m == pytest.approx(height_m, rel=0.1)
    assert one.supported
    assert one.low_m <= one.height_m <= one.high_m


def test_a_width_of_another_side_is_outvoted_by_the_storeys() -> None:
    one = known(told(8 * 4 * STOREY_M, 4))
    assert one.height_m == pytest.approx(4 * STOREY_M, rel=0.2)
    assert one.by_width_m == pytest.approx(8 * 4 * STOREY_M)
    assert one.by_storeys_m == pytest.approx(4 * STOREY_M, rel=0.05)


def test_two_witnesses_are_surer_than_one() -> None:
    alone, both = known(told(18.0)), known(told(18.0, 5))
    assert both.high_m / both.low_m < alone.high_m / alone.low_m


def test_a_guessed_width_says_little_of_the_height() -> None:
    sure, guessed = known(told(40.0)), known(told(40.0, assumed=True))
    assert guessed.high_m / guessed.low_m > 1.3 * sure.high_m / sure.low_m
    assert guessed.by_width_m is None


def test_storeys_of_two_readings_on_a_guessed_width_support_nothing() -> None:
    both = tuple(np.maximum(rows(3), rows(9)))
    one = Shown(("p", 0), 0.5, 0.01, 0.9, both)
    assert not known(Told(10.0, True, one)).supported  # noqa: FBT003


def test_an_elevation_of_which_nothing_repeats_tells_no_storeys() -> None:
    flat = Shown(("p", 0), 0.5, 0.01, 0.9, tuple(np.zeros(len(COUNTS))))
    assert known(Told(8.0, False, flat)).by_storeys_m is None  # noqa: FBT003


def test_nothing_told_is_no_height() -> None:
    assert heights.height([]) is None


@pytest.mark.parametrize("count", [1, 2, 5])
def test_a_belief_is_a_density(count: int) -> None:
    one = heights.belief([told(18.0, 5)] * count)
    assert one.sum() == pytest.approx(1.0)
    assert one.shape == HEIGHTS_M.shape
    assert (one >= 0).all()


def test_a_list_of_storeys_settles_what_elevations_leave_open() -> None:
    lost = Told(8.0, True, Shown(("p", 0), 0.2, 0.004, 0.9))  # noqa: FBT003
    alone, listed = heights.height([lost]), heights.height([lost], 5.0)
    assert alone is not None
    assert listed is not None
    assert listed.height_m == pytest.approx(5 * STOREY_M, rel=0.15)
    assert listed.high_m / listed.low_m < alone.high_m / alone.low_m
    assert listed.by_list_m == pytest.approx(5 * STOREY_M)


def test_a_list_alone_gives_a_height_that_is_supported() -> None:
    listed = heights.height([], 6.0)
    assert listed is not None
    assert listed.supported
    assert listed.low_m < 6 * STOREY_M < listed.high_m


def test_a_list_of_another_building_is_outvoted_and_named() -> None:
    sure = [
        Told(width_m, False, Shown(("p", n), width_m / 18.0, 0.01, 0.9, rows(5)))  # noqa: FBT003
        for n, width_m in enumerate((8.0, 12.0, 20.0))
    ]
    listed = heights.height(sure, 40.0)
    assert listed is not None
    assert listed.height_m == pytest.approx(18.0, rel=0.25)
    assert listed.contradicting == ("list",)
