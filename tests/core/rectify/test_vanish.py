import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nostalgin_core.rectify import upright, vanish

UP = np.array([[0.0, -1.0, 0.0]])


def pencil(point: np.ndarray, count: int, seed: int, sd: float = 0.0) -> np.ndarray:
    """Draw lines in the unit square that run to one homogeneous point."""
    rng = np.random.default_rng(seed)
    start = rng.uniform(-0.5, 0.5, (count, 2))
    ray = point[:2] - start * point[2]
    ray /= np.linalg.norm(ray, axis=1, keepdims=True)
    stop = start + ray * rng.uniform(0.05, 0.3, (count, 1))
    lines = np.hstack([start, stop])
    return lines + rng.normal(0, sd, lines.shape)


@given(x=st.floats(-5, 5), y=st.floats(-5, 5), w=st.sampled_from([0.0, 0.2, 1.0]))
def test_lines_of_a_pencil_are_at_no_distance(x: float, y: float, w: float) -> None:
    point = np.array([x, y + 7.0, w])
    lines = pencil(point, 5, 0)
    assert vanish.distance_deg(point[None], lines).max() < 1e-3


@given(scale=st.floats(0.1, 10).flatmap(lambda s: st.sampled_from([s, -s])))
def test_a_points_scale_and_sign_mean_nothing(scale: float) -> None:
    point, lines = np.array([[3.0, 1.0, 0.5]]), pencil(UP[0], 7, 1)
    np.testing.assert_allclose(
        vanish.distance_deg(point, lines), vanish.distance_deg(point * scale, lines)
    )


def test_far_points_come_to_those_at_infinity() -> None:
    lines = pencil(np.array([2.0, 0.0, 1.0]), 9, 2)
    far, infinite = np.array([[1e9, 3e9, 1.0]]), np.array([[1.0, 3.0, 0.0]])
    np.testing.assert_allclose(
        vanish.distance_deg(far, lines), vanish.distance_deg(infinite, lines), atol=1e-5
    )


def test_all_aligned_lines_give_every_vote_and_crossing_ones_none() -> None:
    lines = pencil(UP[0], 10, 3)
    weights = np.ones(10)
    across = np.array([[1.0, 0.0, 0.0]])
    assert vanish.vote(UP, lines, weights)[0] == pytest.approx(1.0)
    assert vanish.vote(across, lines, weights)[0] == 0.0


def test_a_line_beyond_the_threshold_is_silent() -> None:
    lines = pencil(UP[0], 10, 3)
    crossing = pencil(np.array([1.0, 0.0, 0.0]), 10, 4)
    both = np.vstack([lines, crossing])
    assert vanish.vote(UP, both, np.ones(20))[0] == pytest.approx(0.5)


def test_parallel_lines_meet_at_infinity() -> None:
    lines = np.array([[0.0, 0.0, 0.0, 1.0], [0.5, 0.0, 0.5, 1.0]])
    (point,) = vanish.intersections(lines)
    np.testing.assert_allclose(np.abs(point), [0, 1, 0], atol=1e-12)


def test_of_collinear_lines_the_longest_stays() -> None:
    lines = np.array([[0.0, 0.0, 0.1, 0.0], [0.2, 0.0, 0.5, 0.0], [0.0, 0.2, 0.1, 0.2]])
    kept = vanish.without_collinear(lines)
    np.testing.assert_array_equal(kept, lines[1:])


def test_opposite_ends_of_infinity_are_one_candidate() -> None:
    points = np.array([[1.0, 0.001, 0.001], [-1.0, 0.001, 0.002], [0.0, 1.0, 0.0]])
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    assert len(vanish.without_doubles(points)) == 2


def test_taking_out_doubles_moves_the_winner_by_little() -> None:
    point = np.array([1.4, 0.3, 0.9])
    lines = np.vstack([pencil(point, 40, 5, 0.001), pencil(UP[0], 20, 6)])
    points, weights = vanish.intersections(lines), np.ones(len(lines))
    fewer = vanish.without_doubles(points)
    assert len(fewer) < 0.7 * len(points)
    winners = [p[vanish.vote(p, lines, weights).argmax()] for p in (points, fewer)]
    assert abs(winners[0] @ winners[1]) > np.cos(np.radians(1.0))


def test_the_vertical_is_found_among_other_lines() -> None:
    true = np.array([0.05, -3.0, 1.0])
    lines = np.vstack(
        [pencil(true, 40, 7, 0.0005), pencil(np.array([4.0, 0.5, 1.0]), 30, 8, 0.0005)]
    )
    found, share = vanish.best_vertical(lines, lines, vanish.lengths(lines))
    true = true / np.linalg.norm(true)
    assert np.degrees(np.arccos(abs(found @ true))) < 1.0
    assert 0.3 < share < 0.9


def test_candidates_taken_are_apart() -> None:
    rng = np.random.default_rng(9)
    points = rng.normal(size=(50, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    taken = vanish.spread_out(points, rng.random(50), most=4)
    cosines = np.abs(taken @ taken.T) - np.eye(len(taken))
    assert cosines.max() < np.cos(np.radians(vanish.APART_DEG)) + 1e-9


def test_horizontals_correct_a_vertical_that_scratches_outvote() -> None:
    parameters = np.array([0.0, 0.02, 0.25, -0.6, 0.9])
    axes = upright.axes(parameters)
    scratches = UP[0]
    agreed = vanish.agreed_up(scratches, 0.2, axes[1:], np.array([1.0, 1.0]))
    assert abs(agreed @ axes[0]) > abs(scratches @ axes[0])
    assert np.degrees(np.arccos(abs(agreed @ axes[0]))) < 4.0
