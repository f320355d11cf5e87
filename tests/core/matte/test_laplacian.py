import numpy as np
import pytest

from nostalgin_core.matte import laplacian
from tests.core.matte.dense import noise, whole


def _slow(light: np.ndarray, epsilon: float) -> np.ndarray:
    """The matting Laplacian as equation 12 has it: window by window, entry by entry."""
    h, w = light.shape
    matrix = np.zeros((h * w, h * w))
    for y in range(1, h - 1):
        for x in range(1, w - 1):
            ys, xs = np.mgrid[y - 1 : y + 2, x - 1 : x + 2]
            here = (ys * w + xs).ravel()
            values = light[ys, xs].ravel()
            off = values - values.mean()
            affinity = (1 + np.outer(off, off) / (values.var() + epsilon / 9)) / 9
            matrix[np.ix_(here, here)] += np.eye(9) - affinity
    return matrix


@pytest.mark.parametrize("shape", [(9, 11), (3, 3), (3, 12), (12, 4)])
@pytest.mark.parametrize("epsilon", [1e-7, 1e-3])
def test_the_system_is_levins_matrix_without_known_rows(
    shape: tuple[int, int], epsilon: float
) -> None:
    light, alpha = noise(*shape), noise(*shape, seed=1)
    unknown = noise(*shape, seed=2) > 0.4
    slow = _slow(light, epsilon)
    u = unknown.ravel()
    system = laplacian.system(light, unknown, alpha, epsilon=epsilon)
    np.testing.assert_allclose(whole(system), slow[np.ix_(u, u)], atol=1e-9)
    right = -slow[np.ix_(u, ~u)] @ alpha.ravel()[~u]
    np.testing.assert_allclose(system.right, right, atol=1e-9)


def test_even_windows_do_not_blow_up() -> None:
    light = np.full((7, 9), 0.6)
    system = laplacian.system(light, np.ones((7, 9), bool), light, epsilon=1e-7)
    np.testing.assert_allclose(whole(system), _slow(light, 1e-7), atol=1e-6)


def test_what_is_affine_in_the_image_costs_nothing() -> None:
    """The Laplacian's null space, up to epsilon (section 3 of Levin's paper)."""
    light = noise(12, 14)
    unknown = np.zeros((12, 14), bool)
    unknown[3:9, 4:11] = True
    alpha = 0.2 + 0.7 * light
    system = laplacian.system(light, unknown, alpha, epsilon=1e-12)
    np.testing.assert_allclose(whole(system) @ alpha[unknown], system.right, atol=1e-8)
