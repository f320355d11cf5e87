import numpy as np
import pytest

from nostalgin_core.block import outline
from nostalgin_core.block.outline import Measured

FOUR = [
    [100.0, 60.0, 100.0, 60.0],
    [100.0, 60.0, 90.0, 75.0],
    [20.0, 200.0, 50.0, 190.0],
    [5.0, 300.0, 300.0, 5.0],
]


def measured(
    lengths_m: list[float], sd: float = 0.03, free: frozenset[int] = frozenset()
) -> list[Measured]:
    headings = outline.nominal_headings(len(lengths_m))
    return [
        Measured(
            length,
            sd,
            float(heading),
            (1.0 if len(lengths_m) == 4 else 0.3) if side in free else 0.0,
        )
        for side, (length, heading) in enumerate(zip(lengths_m, headings, strict=True))
    ]


def end(lengths_m: np.ndarray, headings: np.ndarray) -> np.ndarray:
    ahead = np.column_stack([np.cos(headings), np.sin(headings)])
    return lengths_m @ ahead


@pytest.mark.parametrize("lengths_m", FOUR)
def test_a_walk_round_four_sides_comes_home(lengths_m: list[float]) -> None:
    np.testing.assert_allclose(end(*outline.close(measured(lengths_m))), 0, atol=1e-6)


@pytest.mark.parametrize("n", range(3, 9))
@pytest.mark.parametrize("seed", range(3))
def test_a_walk_round_any_number_of_free_sides_comes_home(n: int, seed: int) -> None:
    lengths_m = np.random.default_rng(seed).uniform(20, 60, n).tolist()
    closed = outline.close(measured(lengths_m, free=frozenset(range(n))))
    np.testing.assert_allclose(end(*closed), 0, atol=1e-6)


@pytest.mark.parametrize("lengths_m", FOUR)
def test_opposite_sides_of_a_rectangle_agree(lengths_m: list[float]) -> None:
    closed_m, _ = outline.close(measured(lengths_m))
    np.testing.assert_allclose(closed_m[:2], closed_m[2:], rtol=1e-6)


@pytest.mark.parametrize(("width_m", "depth_m"), [(80.0, 50.0), (6.0, 290.0)])
def test_what_closes_already_is_left_alone(width_m: float, depth_m: float) -> None:
    sides = [width_m, depth_m, width_m, depth_m]
    closed_m, headings = outline.close(measured(sides))
    np.testing.assert_allclose(closed_m, sides, rtol=1e-9)
    np.testing.assert_allclose(headings, outline.nominal_headings(4), atol=1e-9)


@pytest.mark.parametrize("n", range(3, 9))
@pytest.mark.parametrize("seed", range(3))
def test_it_does_not_matter_at_which_side_the_walk_begins(n: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    sides = [
        Measured(
            float(rng.uniform(20, 250)),
            float(rng.uniform(0.01, 0.4)),
            float(heading),
            0.0 if n == 4 else 0.3,
        )
        for heading in outline.nominal_headings(n)
    ]
    here_m, headings = outline.close(sides)
    there_m, turned = outline.close([*sides[2:], *sides[:2]])
    np.testing.assert_allclose(np.roll(there_m, 2), here_m, rtol=0, atol=3e-9)
    np.testing.assert_allclose(np.roll(turned, 2), headings, rtol=0, atol=3e-9)


def test_the_side_known_better_moves_less() -> None:
    sides = measured([100.0, 60.0, 90.0, 60.0])
    sides[0] = Measured(100.0, 0.5, 0.0)  # hardly known
    closed_m, _ = outline.close(sides)
    assert abs(closed_m[0] - 95.0) < 6
    sides[0] = Measured(100.0, 0.001, 0.0)
    assert abs(outline.close(sides)[0][0] - 100.0) < 0.1


def test_a_side_that_nothing_is_known_of_takes_its_opposite_s_length() -> None:
    sides = measured([80.0, 50.0, 10.0, 50.0])
    sides[2] = Measured(10.0, outline.UNKNOWN_SD, sides[2].heading_rad)
    closed_m, _ = outline.close(sides)
    np.testing.assert_allclose(closed_m, [80, 50, 80, 50], rtol=0.02)


def test_a_free_side_finds_the_slant_of_a_true_trapezoid() -> None:
    # 40 St, Broadway, 41 St, 7 Avenue: the avenue square to both streets
    slant = float(np.hypot(17.0, 60.0))
    sides = measured([65.0, slant, 48.0, 60.0], free=frozenset({1}))
    closed_m, headings = outline.close(sides)
    np.testing.assert_allclose(closed_m, [65.0, slant, 48.0, 60.0], rtol=0.05)
    np.testing.assert_allclose(headings[1], np.pi / 2 + np.arctan2(17, 60), atol=0.06)


def test_corners_start_at_the_origin_and_follow_the_sides() -> None:
    corners = outline.corners(
        np.array([3.0, 2.0, 3.0, 2.0]), outline.nominal_headings(4)
    )
    np.testing.assert_allclose(corners, [[0, 0], [3, 0], [3, 2], [0, 2]], atol=1e-12)


@pytest.mark.parametrize("lengths_m", [[10.0, 10.0], [10.0, 0.0, 10.0]])
def test_what_is_no_ring_is_refused(lengths_m: list[float]) -> None:
    with pytest.raises(ValueError, match="no ring closes"):
        outline.close(measured(lengths_m))
