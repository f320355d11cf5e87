import cv2
import numpy as np
import pytest

from nostalgin_core.matte import closed_form
from nostalgin_core.matte.laplacian import Belief
from nostalgin_core.matte.trimap import BACKGROUND, FOREGROUND, UNKNOWN
from tests.data import DATA, needs_data


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
    found = closed_form.alpha(image, _around(alpha, 6))
    assert found.dtype == np.float32
    np.testing.assert_allclose(found, alpha, atol=0.02)


def test_known_pixels_stay_known() -> None:
    alpha, image = _blob()
    known = _around(alpha, 3)
    found = closed_form.alpha(image, known)
    assert (found[known == FOREGROUND] == 1).all()
    assert (found[known == BACKGROUND] == 0).all()


def test_swapping_the_sides_gives_the_rest() -> None:
    alpha, image = _blob()
    known = _around(alpha, 5)
    noisy = np.clip(image + np.random.default_rng(3).normal(0, 8, image.shape), 0, 255)
    noisy = noisy.astype(np.uint8)
    swapped = np.where(known == UNKNOWN, known, 255 - known).astype(np.uint8)
    np.testing.assert_allclose(
        closed_form.alpha(noisy, known),
        1 - closed_form.alpha(noisy, swapped),
        atol=1e-5,
    )


@pytest.mark.parametrize("size", [(120, 160), (121, 159)])
def test_coarse_to_fine_stays_near_the_exact_alpha(size: tuple[int, int]) -> None:
    alpha, image = _blob(*size)
    known = _around(alpha, 14)
    exact = closed_form.alpha(image, known)
    bounded = closed_form.alpha(image, known, direct=1_000)
    assert np.count_nonzero(known == UNKNOWN) > 4_000
    assert (exact != bounded).any()
    assert np.abs(exact - bounded).mean() < 0.003


def test_a_belief_weighs_the_same_at_half_the_size() -> None:
    alpha, image = _blob()
    known = _around(alpha, 14)
    grain = np.random.default_rng(4).normal(0, 4, image.shape)
    noisy = np.clip(image * 0.2 + 90 + grain, 0, 255).astype(np.uint8)
    unsure = Belief(np.full(alpha.shape, 0.5, np.float32), 0.01)
    exact = closed_form.alpha(noisy, known, prior=unsure, epsilon=1e-5)
    halved = closed_form.alpha(noisy, known, prior=unsure, epsilon=1e-5, direct=1_000)
    assert np.abs(exact - halved)[known == UNKNOWN].mean() < 0.009


@pytest.mark.parametrize("direct", [20_000, 1_000])
def test_a_strong_belief_is_followed_and_a_weak_one_is_not(direct: int) -> None:
    alpha, image = _blob()
    known = _around(alpha, 6)
    belief = np.full(alpha.shape, 0.5, np.float32)
    weak = closed_form.alpha(image, known, prior=Belief(belief, 1e-6), direct=direct)
    strong = closed_form.alpha(image, known, prior=Belief(belief, 1e4), direct=direct)
    np.testing.assert_allclose(weak, alpha, atol=0.02)
    np.testing.assert_allclose(strong[known == UNKNOWN], 0.5, atol=0.01)


def test_a_margin_round_the_band_changes_nothing() -> None:
    alpha, image = _blob()
    known = _around(alpha, 4)
    wide = [np.pad(one, 40, mode="edge") for one in (image, known)]
    found = closed_form.alpha(*wide)[40:-40, 40:-40]
    np.testing.assert_array_equal(found, closed_form.alpha(image, known))


def test_a_trimap_that_knows_nothing_is_a_mistake() -> None:
    image = np.zeros((8, 8), np.uint8)
    with pytest.raises(ValueError, match="without a known pixel"):
        closed_form.alpha(image, np.full((8, 8), UNKNOWN, np.uint8))


def test_a_trimap_that_knows_everything_is_the_answer() -> None:
    known = np.where(
        np.random.default_rng(0).random((8, 9)) > 0.5, FOREGROUND, BACKGROUND
    ).astype(np.uint8)
    found = closed_form.alpha(np.zeros((8, 9), np.uint8), known)
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
    found = closed_form.alpha(read("Images"), known)
    assert ((found - truth)[unknown] ** 2).mean() < 1.05 * PEER_MSE[name]
