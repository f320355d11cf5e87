import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nostalgin_core.rectify import upright, vanish

angles = st.floats(-0.4, 0.4)


def lines_of(
    parameters: np.ndarray, axis: int, count: int, *, seed: int, sd: float = 0.0
) -> np.ndarray:
    """Draw lines in view that run to one of the world's vanishing points."""
    rng = np.random.default_rng(seed)
    point = upright.vanishing_points(parameters)[axis]
    middle = rng.uniform(-0.5, 0.5, (count, 2))
    ray = point[:2] - middle * point[2]
    ray /= np.linalg.norm(ray, axis=1, keepdims=True)
    half = ray * rng.uniform(0.02, 0.08, (count, 1))
    lines = np.hstack([middle - half, middle + half])
    return lines + rng.normal(0, sd, lines.shape)


def fitted(true: np.ndarray, start: np.ndarray, *, sd: float, seed: int = 0):  # noqa: ANN201
    """Fit a world of two fronts to lines with noise."""
    groups = [
        (lines_of(true, 0, 60, seed=seed, sd=sd), 0),
        (lines_of(true, 1, 40, seed=seed + 1, sd=sd), 1),
        (lines_of(true, 0, 60, seed=seed + 2, sd=sd), 1),
        (lines_of(true, 2, 40, seed=seed + 3, sd=sd), 2),
    ]
    lines = np.vstack([g for g, _ in groups])
    front = np.concatenate([np.full(len(g), max(i, 1)) for g, i in groups])
    open_to = np.arange(3) == front[:, None]
    open_to[:, 0] = True
    ones = np.ones(len(lines))
    return upright.fit(start, lines, open_to, ones, vanish.lengths(lines) * 700)


@given(roll=angles, tilt=angles, theta=st.floats(-3, 3))
def test_axes_are_units_and_horizontals_are_square_to_up(
    roll: float, tilt: float, theta: float
) -> None:
    axes = upright.axes(np.array([0.0, roll, tilt, theta, theta + np.pi / 2]))
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-9)


@given(roll=angles, tilt=angles, theta=st.floats(-1.5, 1.5))
def test_a_start_from_true_points_is_the_truth(
    roll: float, tilt: float, theta: float
) -> None:
    true = np.array([0.0, roll, tilt, theta])
    points = upright.vanishing_points(true)
    start = upright.start(points[0], points[1:])
    np.testing.assert_allclose(
        np.abs(np.sum(upright.axes(start) * upright.axes(true), axis=1)), 1, atol=1e-9
    )


@given(theta=st.floats(-3, 3), tilt=st.floats(0, 0.4))
def test_level_lines_tell_their_azimuth(theta: float, tilt: float) -> None:
    true = np.array([0.1, 0.03, tilt, theta])
    found = upright.azimuths(true, lines_of(true, 1, 8, seed=1))
    np.testing.assert_allclose(np.sin(found - theta), 0, atol=1e-6)


def test_clean_lines_give_the_world_back() -> None:
    true = np.array([0.15, 0.02, 0.2, -0.6, -0.6 + np.pi / 2])
    world = fitted(true, true + np.array([-0.15, 0.01, 0.02, 0.02, -0.02]), sd=0.0)
    np.testing.assert_allclose(world.parameters, true, atol=0.01)


@pytest.mark.parametrize("seed", range(3))
def test_outliers_hardly_move_the_world(seed: int) -> None:
    true = np.array([0.1, 0.01, 0.25, -0.5, -0.5 + np.pi / 2])
    world = fitted(true, true + 0.01, sd=0.0008, seed=10 * seed)
    axes, found = upright.axes(true), upright.axes(world.parameters)
    off = np.degrees(np.arccos(np.minimum(np.abs(np.sum(axes * found, axis=1)), 1)))
    assert off.max() < 1.0


def test_analytic_zeros_of_the_jacobian_are_zeros() -> None:
    true = np.array([0.1, 0.01, 0.25, -0.5, 0.9])
    lines = np.vstack([lines_of(true, a, 5, seed=a, sd=0.01) for a in range(3)])
    axis = np.repeat([0, 1, 2], 5)
    here = upright.sines(true, lines, axis)
    jacobian = upright.slopes(true, lines, axis, here)
    for i in range(5):
        step = np.zeros(5)
        step[i] = upright.DELTA
        moved = (upright.sines(true + step, lines, axis) - here) / upright.DELTA
        np.testing.assert_allclose(jacobian[:, i], moved, atol=1e-9)


def test_noisier_lines_make_a_less_certain_world() -> None:
    true = np.array([0.1, 0.01, 0.25, -0.5, -0.5 + np.pi / 2])
    calm, rough = (fitted(true, true + 0.01, sd=sd) for sd in (0.0002, 0.003))
    assert np.all(np.diag(rough.covariance) > np.diag(calm.covariance))
    assert upright.directions_sd_deg(rough, 0) > upright.directions_sd_deg(calm, 0)


def test_without_lines_the_prior_is_all_that_is_known() -> None:
    start = np.array([0.0, 0.0, 0.1, 0.3])
    nothing = np.empty(0)
    world = upright.fit(
        start, np.empty((0, 4)), np.empty((0, 2), bool), nothing, nothing
    )
    assert world.support.tolist() == [0.0, 0.0]
    assert np.sqrt(world.covariance[0, 0]) == pytest.approx(upright.LOG_FOCAL[1])


@pytest.mark.parametrize("factor", [0.2, 0.5, 1.0])
def test_the_spread_is_the_lines_variance_over_the_assumed(factor: float) -> None:
    rng = np.random.default_rng(4)
    sd = rng.uniform(0.006, 0.012, 4000)
    missed = np.abs(rng.normal(0, factor * sd))
    ones = np.ones(4000)
    assert upright.spread(missed, sd, ones) == pytest.approx(factor**2, rel=0.1)


def test_strays_beyond_the_first_gate_do_not_widen_the_spread() -> None:
    rng = np.random.default_rng(5)
    sd, ones = np.full(300, 0.01), np.ones(300)
    missed = np.abs(rng.normal(0, sd))
    strayed = np.concatenate([missed, np.full(300, 0.2)])
    twice = np.concatenate([sd, sd]), np.concatenate([ones, ones])
    assert upright.spread(strayed, *twice) == upright.spread(missed, sd, ones)


def test_without_lines_the_assumed_variance_holds() -> None:
    nothing = np.empty(0)
    assert upright.spread(nothing, nothing, nothing) == 1.0


def test_a_line_belongs_to_the_axis_that_it_misses_least_and_is_open_to() -> None:
    true = np.array([0.1, 0.01, 0.25, -0.5, 0.9])
    lines = np.vstack([lines_of(true, a, 5, seed=a) for a in range(3)])
    every = np.ones((15, 3), bool)
    axis, missed = upright.nearest(true, lines, every)
    np.testing.assert_array_equal(axis, np.repeat([0, 1, 2], 5))
    np.testing.assert_allclose(missed, 0, atol=1e-9)
    closed = every.copy()
    closed[0] = False
    closed[5:10, 1] = False
    axis, missed = upright.nearest(true, lines, closed)
    assert missed[0] == np.inf
    assert not np.any(axis[5:10] == 1)
