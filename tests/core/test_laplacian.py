import cv2
import numpy as np
import pytest
from scipy import sparse

from nostalgin_core import laplacian
from nostalgin_core.laplacian import Belief, System
from nostalgin_core.trimap import BACKGROUND, FOREGROUND, UNKNOWN
from tests.data import DATA, needs_data


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


def _whole(system: System) -> np.ndarray:
    n = len(system.right)
    there = system.neighbours >= 0
    rows = np.broadcast_to(np.arange(n), there.shape)[there]
    upper = sparse.coo_array(
        (system.values[there], (rows, system.neighbours[there])), shape=(n, n)
    ).toarray()
    return upper + np.triu(upper, 1).T


def _noise(h: int, w: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).random((h, w))


@pytest.mark.parametrize("shape", [(9, 11), (3, 3), (3, 12), (12, 4)])
@pytest.mark.parametrize("epsilon", [1e-7, 1e-3])
def test_the_system_is_levins_matrix_without_known_rows(
    shape: tuple[int, int], epsilon: float
) -> None:
    light, alpha = _noise(*shape), _noise(*shape, seed=1)
    unknown = _noise(*shape, seed=2) > 0.4
    slow = _slow(light, epsilon)
    u = unknown.ravel()
    system = laplacian.system(light, unknown, alpha, epsilon=epsilon)
    np.testing.assert_allclose(_whole(system), slow[np.ix_(u, u)], atol=1e-9)
    right = -slow[np.ix_(u, ~u)] @ alpha.ravel()[~u]
    np.testing.assert_allclose(system.right, right, atol=1e-9)


def test_even_windows_do_not_blow_up() -> None:
    light = np.full((7, 9), 0.6)
    system = laplacian.system(light, np.ones((7, 9), bool), light, epsilon=1e-7)
    np.testing.assert_allclose(_whole(system), _slow(light, 1e-7), atol=1e-6)


def test_what_is_affine_in_the_image_costs_nothing() -> None:
    """The Laplacian's null space, up to epsilon (section 3 of Levin's paper)."""
    light = _noise(12, 14)
    unknown = np.zeros((12, 14), bool)
    unknown[3:9, 4:11] = True
    alpha = 0.2 + 0.7 * light
    system = laplacian.system(light, unknown, alpha, epsilon=1e-12)
    np.testing.assert_allclose(_whole(system) @ alpha[unknown], system.right, atol=1e-8)


def test_both_solvers_find_the_dense_solution() -> None:
    light = _noise(20, 24)
    unknown = np.zeros((20, 24), bool)
    unknown[2:7, 3:20] = unknown[12:16, 1:9] = True
    known = (np.arange(24) > 12) * np.ones((20, 1))
    system = laplacian.system(light, unknown, known)
    ranks = laplacian.order(unknown).ranks
    assert sorted(ranks) == list(range(len(ranks)))
    dense = np.linalg.solve(_whole(system), system.right)
    for solve in (laplacian.banded_solve, laplacian.sparse_solve):
        np.testing.assert_allclose(solve(system, ranks), dense, atol=1e-7)


def test_a_ring_is_a_few_times_as_wide_as_its_band() -> None:
    disc = np.zeros((300, 300), np.uint8)
    cv2.circle(disc, (150, 150), 110, 1, 8)
    ring = laplacian.order(disc > 0)
    assert ring.entries / len(ring.ranks) < 8 * 9


def _blob(h: int = 120, w: int = 160) -> tuple[np.ndarray, np.ndarray]:
    """A soft bright blob on dark ground, with alpha = its light, scaled."""
    y, x = np.mgrid[:h, :w]
    alpha = np.clip((45 - np.hypot(x - 80, y - 60)) / 8 + 0.5, 0, 1)
    return alpha, np.round(40 + 150 * alpha).astype(np.uint8)


def _around(alpha: np.ndarray, px: int) -> np.ndarray:
    band = cv2.dilate(
        ((alpha > 0) & (alpha < 1)).astype(np.uint8), np.ones((2 * px + 1,) * 2)
    )
    known = np.where(alpha > 0.5, FOREGROUND, BACKGROUND)
    return np.where(band > 0, UNKNOWN, known).astype(np.uint8)


def test_painted_alpha_comes_out_again() -> None:
    alpha, image = _blob()
    found = laplacian.alpha(image, _around(alpha, 6))
    assert found.dtype == np.float32
    np.testing.assert_allclose(found, alpha, atol=0.02)


def test_known_pixels_stay_known() -> None:
    alpha, image = _blob()
    known = _around(alpha, 3)
    found = laplacian.alpha(image, known)
    assert (found[known == FOREGROUND] == 1).all()
    assert (found[known == BACKGROUND] == 0).all()


def test_swapping_the_sides_gives_the_rest() -> None:
    alpha, image = _blob()
    known = _around(alpha, 5)
    noisy = np.clip(image + np.random.default_rng(3).normal(0, 8, image.shape), 0, 255)
    noisy = noisy.astype(np.uint8)
    swapped = np.where(known == UNKNOWN, known, 255 - known).astype(np.uint8)
    np.testing.assert_allclose(
        laplacian.alpha(noisy, known), 1 - laplacian.alpha(noisy, swapped), atol=1e-5
    )


@pytest.mark.parametrize("size", [(120, 160), (121, 159)])
def test_coarse_to_fine_stays_near_the_exact_alpha(size: tuple[int, int]) -> None:
    alpha, image = _blob(*size)
    known = _around(alpha, 14)
    exact = laplacian.alpha(image, known)
    bounded = laplacian.alpha(image, known, entries=300_000)
    assert laplacian.order(known == UNKNOWN).entries > 300_000
    assert np.abs(exact - bounded).mean() < 0.003


def test_a_strong_belief_is_followed_and_a_weak_one_is_not() -> None:
    alpha, image = _blob()
    known = _around(alpha, 6)
    belief = np.full(alpha.shape, 0.5, np.float32)
    weak = laplacian.alpha(image, known, prior=Belief(belief, 1e-6))
    strong = laplacian.alpha(image, known, prior=Belief(belief, 1e4))
    np.testing.assert_allclose(weak, alpha, atol=0.02)
    np.testing.assert_allclose(strong[known == UNKNOWN], 0.5, atol=0.01)


def test_a_trimap_that_knows_nothing_is_a_mistake() -> None:
    image = np.zeros((8, 8), np.uint8)
    with pytest.raises(ValueError, match="without a known pixel"):
        laplacian.alpha(image, np.full((8, 8), UNKNOWN, np.uint8))


def test_a_trimap_that_knows_everything_is_the_answer() -> None:
    known = np.where(_noise(8, 9) > 0.5, FOREGROUND, BACKGROUND).astype(np.uint8)
    found = laplacian.alpha(np.zeros((8, 9), np.uint8), known)
    np.testing.assert_array_equal(found, known / np.float32(255))


# What pymatting's closed form makes of the same gray images and first trimaps, as mean
# squared error over the unknown pixels (tests/bench/bench_matte.py prints it).
PEER_MSE = {"GT01": 0.0298, "GT05": 0.0516, "GT15": 0.0209}


@needs_data
@pytest.mark.parametrize("name", PEER_MSE)
def test_true_alpha_is_met_as_closely_as_by_the_peer(name: str) -> None:
    folder = DATA / "matting"

    def read(kind: str) -> np.ndarray:
        path = folder / kind / f"{name}.png"
        return cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)

    known, truth = read("Trimap1"), read("GroundTruth") / 255.0
    unknown = (known != BACKGROUND) & (known != FOREGROUND)
    found = laplacian.alpha(read("Images"), known)
    assert ((found - truth)[unknown] ** 2).mean() < 1.05 * PEER_MSE[name]
