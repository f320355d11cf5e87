import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nostalgin_core.rectify import vanish
from pipelines.evaluate import sphere
from tests.core.rectify.test_vanish import pencil

POINTS = {
    "finite": np.array([1.4, 0.3, 0.9]),
    "far": np.array([5.0, -1.0, 0.02]),
    "infinite": np.array([0.1, -1.0, 0.0]),
}


def apart_deg(one: np.ndarray, other: np.ndarray) -> float:
    """Measure the angle between two points on the sphere."""
    one, other = one / np.linalg.norm(one), other / np.linalg.norm(other)
    return float(np.degrees(np.arcsin(min(1.0, np.linalg.norm(np.cross(one, other))))))


@pytest.mark.parametrize("kind", POINTS)
def test_the_point_of_a_pencil_stays_where_it_is(kind: str) -> None:
    true = POINTS[kind]
    lines = pencil(true, 12, 0)
    found = sphere.refined(true / np.linalg.norm(true), lines, np.ones(12))
    assert apart_deg(found, true) < 1e-4


@pytest.mark.parametrize("kind", POINTS)
def test_a_point_of_two_lines_comes_nearer_to_the_truth(kind: str) -> None:
    true = POINTS[kind]
    lines = pencil(true, 60, 1, 0.0005)
    weights = vanish.lengths(lines)
    start = vanish.intersections(lines[:2])[0]
    found = sphere.refined(start, lines, weights)
    assert apart_deg(found, true) < 0.5 * apart_deg(start, true)


@given(seed=st.integers(0, 20))
def test_neighbours_are_drawn_to_one_point(seed: int) -> None:
    true = POINTS["finite"]
    lines = np.vstack([pencil(true, 40, 2, 0.001), pencil(POINTS["infinite"], 20, 3)])
    rng = np.random.default_rng(seed)
    starts = true / np.linalg.norm(true) + rng.normal(0, 0.004, (2, 3))
    one, other = (sphere.refined(s, lines, np.ones(60)) for s in starts)
    assert apart_deg(one, other) < 0.01


def test_a_line_across_has_no_say() -> None:
    true = POINTS["finite"]
    lines = pencil(true, 20, 4)
    across = np.array([[0.0, 0.4, 0.1, -0.4]])
    assert vanish.distance_deg(true[None], across)[0, 0] > vanish.ALIGNED_DEG
    found = sphere.refined(
        true / np.linalg.norm(true), np.vstack([lines, across]), np.ones(21)
    )
    assert apart_deg(found, true) < 1e-4


def test_the_winner_does_not_hang_on_which_candidates_are_left() -> None:
    lines = np.vstack(
        [pencil(POINTS["finite"], 40, 5, 0.001), pencil(POINTS["far"], 38, 6, 0.001)]
    )
    weights = np.ones(len(lines))
    points = vanish.intersections(lines)
    fewer = vanish.without_doubles(points)
    winners = [
        sphere.best(p, vanish.vote(p, lines, weights), lines, weights)
        for p in (points, fewer, fewer[::-1])
    ]
    assert apart_deg(winners[0], winners[1]) < 0.01
    assert apart_deg(winners[0], winners[2]) < 0.01


def test_no_candidate_is_a_mistake() -> None:
    nothing = np.empty(0)
    with pytest.raises(ValueError, match="no candidate"):
        sphere.best(np.empty((0, 3)), nothing, np.empty((0, 4)), nothing)
