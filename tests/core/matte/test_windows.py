from itertools import pairwise

import numpy as np
import pytest

from nostalgin_core.matte import laplacian
from nostalgin_core.matte.descent import descend
from nostalgin_core.matte.windows import Windows, windows


def _noise(h: int, w: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).random((h, w)).astype(np.float32)


def _dense(system: laplacian.System) -> np.ndarray:
    matrix = np.zeros([len(system.right)] * 2)
    for values, others in zip(system.values, system.neighbours, strict=True):
        (rows,) = np.nonzero(others >= 0)
        matrix[rows, others[rows]] = matrix[others[rows], rows] = values[rows]
    return matrix


def _band(h: int = 24, w: int = 30) -> np.ndarray:
    unknown = np.zeros((h, w), bool)
    unknown[4:12, 5:25] = unknown[12:20, 17:25] = True
    return unknown


def _at(held: Windows, image: np.ndarray) -> np.ndarray:
    return image.ravel()[held.places].astype(np.float32)


@pytest.mark.parametrize("shape", [(9, 11), (3, 3), (3, 12), (12, 4)])
@pytest.mark.parametrize("epsilon", [1e-5, 1e-3])
def test_windows_apply_the_matrix_that_laplacian_writes_down(
    shape: tuple[int, int], epsilon: float
) -> None:
    light, alpha = _noise(*shape), _noise(*shape, seed=1)
    unknown = _noise(*shape, seed=2) > 0.4
    held = windows(light, unknown, epsilon=epsilon)
    system = laplacian.system(light, unknown, alpha, epsilon=epsilon)
    slow = _dense(system) @ alpha[unknown] - system.right
    residual = np.zeros(shape, np.float32)
    residual.ravel()[held.places] = held.residual(_at(held, alpha))
    np.testing.assert_allclose(residual[unknown], slow, atol=1e-5)
    assert (residual[~unknown] == 0).all()
    diagonal = np.zeros(shape, np.float32)
    diagonal.ravel()[held.places] = held.diagonal
    np.testing.assert_allclose(diagonal[unknown], system.values[0], atol=1e-5)


def test_what_is_affine_in_the_image_costs_nothing() -> None:
    light = _noise(24, 30)
    held = windows(light, _band(), epsilon=1e-9)
    assert np.abs(held.residual(_at(held, 0.2 + 0.7 * light))).max() < 1e-5


def test_enough_steps_reach_the_solution_of_the_direct_solver() -> None:
    light, known = _noise(24, 30), (np.arange(30) > 12) * np.ones((24, 1))
    unknown = _band()
    held = windows(light, unknown, epsilon=1e-4)
    start = np.where(unknown, 0.5, known)
    found = descend(held, _at(held, start), steps=2000, settled=0.0)
    system = laplacian.system(light, unknown, known, epsilon=1e-4)
    exact = known.copy()
    exact[unknown] = np.linalg.solve(_dense(system), system.right)
    np.testing.assert_allclose(found, _at(held, exact), atol=2e-3)


def test_every_step_lessens_the_cost_and_known_pixels_stay() -> None:
    light, unknown = _noise(24, 30), _band()
    held = windows(light, unknown, epsilon=1e-4)
    start = _at(held, np.where(unknown, 0.5, np.arange(30) > 12))
    belief = _at(held, _noise(24, 30, seed=4))

    def cost(alpha: np.ndarray) -> float:
        explained = held.matrix @ alpha
        off = (alpha - belief) * held.unknown
        within = held.counts @ (alpha * alpha) - explained @ explained
        return float(within + 0.1 * off @ off)

    results = [
        descend(held, start, belief=belief, weight=0.1, steps=n, settled=0.0)
        for n in range(8)
    ]
    costs = [cost(one) for one in results]
    assert all(b < a for a, b in pairwise(costs))
    for one in results:
        np.testing.assert_array_equal(one[held.unknown == 0], start[held.unknown == 0])


def test_a_solution_is_left_as_it_is() -> None:
    light, unknown = _noise(24, 30), _band()
    held = windows(light, unknown, epsilon=1e-4)
    flat = _at(held, np.ones((24, 30)))
    np.testing.assert_allclose(descend(held, flat, steps=5, settled=1e-6), 1, atol=1e-5)
