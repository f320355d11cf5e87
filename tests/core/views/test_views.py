"""Two painted elevations of one front are laid over each other; of two fronts, not."""

import cv2
import numpy as np
import pytest

from nostalgin_core.views import View, likeness, marks, overlay, probability, turned


def front(seed: int, shape: tuple[int, int] = (420, 300)) -> np.ndarray:
    """Paint rows of equal windows, and on them what tells one wall from the next."""
    rng = np.random.default_rng(seed)
    image = np.full(shape, 150.0, np.float32)
    for row in range(30, shape[0] - 60, 60):
        for column in range(20, shape[1] - 30, 45):
            image[row : row + 36, column : column + 22] = 60
    for _ in range(60):
        y, x = rng.integers(0, shape[0] - 20), rng.integers(0, shape[1] - 30)
        h, w = rng.integers(4, 18), rng.integers(4, 28)
        image[y : y + h, x : x + w] = rng.uniform(20, 240)
    stains = rng.normal(0, 60, (shape[0] // 6, shape[1] // 6)).astype(np.float32)
    return np.clip(image + cv2.resize(stains, shape[::-1]), 0, 255).astype(np.uint8)


def seen_again(image: np.ndarray, matrix: np.ndarray, size: tuple[int, int]) -> View:
    """Show a front as another camera would: elsewhere, softer, in other tones."""
    other = cv2.warpPerspective(image, matrix, size, flags=cv2.INTER_AREA)
    known = cv2.warpPerspective(np.ones_like(image), matrix, size) > 0
    noise = np.random.default_rng(0).normal(0, 6, other.shape)
    softer = cv2.GaussianBlur(0.6 * other.astype(np.float32) + 50, (0, 0), 0.8)
    return View(np.clip(softer + noise, 0, 255).astype(np.uint8), known)


def whole(image: np.ndarray) -> View:
    return View(image, np.ones(image.shape, bool))


def matrix_of(x: float, y: float, east: float, down: float) -> np.ndarray:
    return np.array([[x, 0, east], [0, y, down], [0, 0, 1.0]])


@pytest.mark.parametrize(
    "truth",
    [
        matrix_of(1, 1, 0, 0),
        matrix_of(0.6, 0.66, 10, -20),
        matrix_of(1.3, 1.15, -60, 30),
        np.array([[0.9, 0.02, 5], [-0.01, 0.85, 12], [0, 0, 1.0]]),
    ],
)
def test_one_front_seen_twice_is_laid_over_itself(truth: np.ndarray) -> None:
    image = front(1)
    own, other = whole(image), seen_again(image, truth, (330, 440))
    found = overlay(marks(own), marks(other))
    assert found is not None
    corners = np.array([[[0, 0], [299, 0], [299, 419], [0, 419.0]]])
    gap = cv2.perspectiveTransform(corners, found.matrix)
    gap = gap - cv2.perspectiveTransform(corners, truth)
    assert np.abs(gap).max() < 3.0  # texels of 440
    alike = likeness(own, other, found.matrix)
    assert alike > 0.5
    assert probability(found.support, alike) > 0.95


@pytest.mark.parametrize("seeds", [(1, 2), (2, 1), (3, 4), (5, 8)])
def test_two_fronts_with_the_same_windows_are_told_apart(
    seeds: tuple[int, int],
) -> None:
    one, two = (whole(front(seed)) for seed in seeds)
    found = overlay(marks(one), marks(two))
    support, alike = 0.0, 0.0
    if found is not None:
        support, alike = found.support, likeness(one, two, found.matrix)
    assert probability(support, alike) < 0.5


def test_a_front_in_a_mirror_is_not_told_to_be_the_same() -> None:
    image = front(1)
    mirror = whole(np.ascontiguousarray(image[:, ::-1]))
    found = overlay(marks(whole(image)), marks(mirror))
    if found is not None:
        assert likeness(whole(image), mirror, found.matrix) < 0.1


def test_marks_turned_round_are_those_in_a_mirror() -> None:
    image = front(1)
    mirror = marks(whole(np.ascontiguousarray(image[:, ::-1])))
    found = overlay(turned(marks(whole(image))), mirror)
    assert found is not None
    np.testing.assert_allclose(found.matrix, np.eye(3), atol=1.5)
    like = turned(marks(whole(image))).looks @ mirror.looks.T
    assert np.median(like.max(axis=1)) > 0.95
    again = turned(turned(mirror))
    np.testing.assert_array_equal(again.looks, mirror.looks)
    np.testing.assert_allclose(again.at_px, mirror.at_px, atol=1e-3)


def test_what_no_camera_saw_bears_no_marks() -> None:
    image = front(3)
    known = np.zeros(image.shape, bool)
    known[:, 150:] = True
    found = marks(View(image, known))
    assert len(found.at_px) > 20
    assert found.at_px[:, 0].min() >= 150
    assert np.allclose(np.linalg.norm(found.looks, axis=1), 1, atol=1e-5)


@pytest.mark.parametrize("image", [np.zeros((64, 64), np.uint8), front(1)[:1]])
def test_a_bare_wall_lies_over_nothing(image: np.ndarray) -> None:
    bare = marks(whole(image))
    assert overlay(bare, bare) is None
    assert overlay(bare, marks(whole(front(1)))) is None
    unseen = View(image, np.zeros(image.shape, bool))
    assert likeness(whole(image), unseen, np.eye(3)) == 0.0


def test_more_agreement_is_never_less_probable() -> None:
    by_support = [probability(s, 0.3) for s in (0.0, 5.0, 20.0, 100.0, 1000.0)]
    by_likeness = [probability(20.0, c) for c in (-0.5, 0.0, 0.3, 0.9)]
    assert by_support == sorted(by_support)
    assert by_likeness == sorted(by_likeness)


def test_the_same_elevations_give_the_same_overlay() -> None:
    own = whole(front(4))
    other = seen_again(own.image, matrix_of(0.8, 0.9, 4, 4), (260, 390))
    twice = [overlay(marks(own), marks(other)) for _ in range(2)]
    assert twice[0] is not None
    assert twice[1] is not None
    assert np.array_equal(twice[0].matrix, twice[1].matrix)
    assert twice[0].support == twice[1].support


def test_no_mark_is_found_twice() -> None:
    found = marks(whole(front(1)))
    told = np.column_stack([found.at_px, found.size_px])
    assert len(told) > 100
    assert len(np.unique(told, axis=0)) == len(told)
