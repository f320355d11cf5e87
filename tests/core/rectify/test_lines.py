import cv2
import numpy as np
import pytest

from nostalgin_core.rectify import lines, vanish
from nostalgin_core.rectify.contours import Contours

SQUARE = np.array([[60.3, 50.6], [240.7, 70.2], [225.1, 230.4], [45.9, 215.3]])


def painted(corners: np.ndarray, shape: tuple[int, int] = (300, 300)) -> np.ndarray:
    """Paint a dark polygon on a light ground with edges between pixels."""
    big = np.full((shape[0] * 8, shape[1] * 8), 200, np.uint8)
    cv2.fillPoly(big, [np.rint((corners + 0.5) * 8 - 0.5).astype(np.int32)], 60)
    return cv2.resize(big, shape[::-1], interpolation=cv2.INTER_AREA)


def distance(point: np.ndarray, start: np.ndarray, stop: np.ndarray) -> float:
    along = (stop - start) / np.linalg.norm(stop - start)
    away = point - start
    return float(abs(along[0] * away[1] - along[1] * away[0]))


def test_a_squares_sides_are_found_to_a_tenth_of_a_pixel() -> None:
    (found,) = lines.detect(painted(SQUARE), lines.LOOSE)
    long = found[vanish.lengths(found) > 100]
    assert len(long) == 4
    for line in long.reshape(-1, 2, 2):
        errors = [
            max(distance(end, SQUARE[i], SQUARE[(i + 1) % 4]) for end in line)
            for i in range(4)
        ]
        assert min(errors) < 0.15


def test_a_circle_has_no_long_line() -> None:
    angle = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    circle = 150 + 60 * np.column_stack([np.cos(angle), np.sin(angle)])
    strict, _ = lines.detect(painted(circle), lines.STRICT, lines.LOOSE)
    assert not len(strict) or vanish.lengths(strict).max() < 25


def test_strict_lines_are_no_more_than_loose_ones() -> None:
    rng = np.random.default_rng(1)
    wavy = SQUARE.repeat(9, axis=0) + rng.normal(0, 3, (36, 2))
    strict, loose = lines.detect(painted(wavy), lines.STRICT, lines.LOOSE)
    assert vanish.lengths(strict).sum() <= vanish.lengths(loose).sum()


def test_turned_a_quarter_an_image_gives_the_same_lengths() -> None:
    image = painted(SQUARE)
    (one,) = lines.detect(image, lines.LOOSE)
    (other,) = lines.detect(np.ascontiguousarray(np.rot90(image)), lines.LOOSE)
    first, second = np.sort(vanish.lengths(one)), np.sort(vanish.lengths(other))
    np.testing.assert_allclose(first[-4:], second[-4:], rtol=0.1)


def test_an_even_image_has_no_lines() -> None:
    (found,) = lines.detect(np.full((80, 80), 90, np.uint8), lines.LOOSE)
    assert found.shape == (0, 4)


def test_edges_outside_the_mask_are_not_followed() -> None:
    where = np.zeros((300, 300), bool)
    where[:, 150:] = True
    (found,) = lines.detect(painted(SQUARE), lines.LOOSE, where=where)
    assert len(found)
    assert found[:, [0, 2]].min() > 148


def on_line(bend_deg: float, length: int = 80) -> Contours:
    """Make a contour that bends once, at its middle."""
    half = np.arange(length // 2, dtype=np.float64)
    angle = np.radians(bend_deg)
    first = np.column_stack([half, np.zeros_like(half)])
    second = first[-1] + (half + 1)[:, None] * [np.cos(angle), np.sin(angle)]
    points = np.vstack([first, second])
    return Contours(points, np.zeros(len(points), np.intp))


def test_a_straight_contour_is_linear_throughout() -> None:
    assert lines.linear(on_line(0.0), 8, 9.0).all()


def test_a_corner_is_not_linear_and_its_arms_are() -> None:
    label = lines.linear(on_line(90.0), 8, 9.0)
    assert not label[38:44].any()
    assert label[:32].all()
    assert label[56:].all()


def test_the_second_derivatives_mirror_each_other() -> None:
    contours = on_line(40.0)
    backwards = Contours(contours.points[::-1].copy(), contours.contour)
    left, right = lines.turns(contours, lines.directions(contours), 8)
    left_back, right_back = lines.turns(backwards, lines.directions(backwards), 8)
    np.testing.assert_allclose(left, right_back[::-1], atol=1e-9)
    np.testing.assert_allclose(right, left_back[::-1], atol=1e-9)


def walk(left: np.ndarray, right: np.ndarray, k_s: int, t: float) -> list[bool]:
    """Follow the mended algorithm 1 point by point, for one long contour."""
    n = len(left)
    on_curve = [False] * n
    state = not (right[0] < t and left[0] < t)
    for i in range(n):
        if left[i] >= t:
            state = True
        elif right[i] < t:
            state = False
        on_curve[i] = state
    bent = False
    for i in range(k_s - 1, -1, -1):
        bent = bent or right[i] >= t
        on_curve[i] = bent
    bent = on_curve[n - k_s - 1]
    for i in range(n - k_s, n):
        bent = bent or left[i] >= t
        on_curve[i] = bent
    return [not c for c in on_curve]


@pytest.mark.parametrize("seed", range(8))
def test_the_labels_are_those_of_a_walk_along_the_contour(seed: int) -> None:
    rng = np.random.default_rng(seed)
    turning = np.cumsum(rng.normal(0, 0.12, 120) * (rng.random(120) < 0.3))
    points = np.cumsum(np.column_stack([np.cos(turning), np.sin(turning)]), axis=0)
    contours = Contours(points, np.zeros(120, np.intp))
    left, right = lines.turns(contours, lines.directions(contours), 8)
    expected = walk(left, right, 8, 9.0)
    np.testing.assert_array_equal(lines.linear(contours, 8, 9.0), expected)
