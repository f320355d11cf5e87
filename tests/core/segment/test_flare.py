import cv2
import numpy as np
import pytest

from nostalgin_core.records import Box, Instance, Photo
from nostalgin_core.segment.flare import flares

H, W = 400, 300
FRONT = Box(60, 80, 240, 360)


def _photo(image: np.ndarray) -> Photo:
    return Photo("0" * 16, image.astype(np.uint8), Box(10, 10, W - 10, H - 10))


def _wall(level: float = 120) -> np.ndarray:
    """A front with grain before a burnt-out sky."""
    image = np.full((H, W), 255.0)
    x0, y0, x1, y1 = FRONT
    grain = np.random.default_rng(2).normal(0, 6, (y1 - y0, x1 - x0))
    image[y0:y1, x0:x1] = np.clip(level + grain, 0, 255)
    return image


def _front(box: Box = FRONT) -> Instance:
    size = (box.y1 - box.y0, box.x1 - box.x0)
    return Instance("facade", 0.9, box, np.ones(size, np.float32))


def _spot(image: np.ndarray, x: int, y: int, radius: int) -> np.ndarray:
    return cv2.circle(image.copy(), (x, y), radius, 255.0, -1)


@pytest.mark.parametrize("radius", [20, 35])
def test_a_blown_out_spot_on_a_front_hides_it(radius: int) -> None:
    (flare,) = flares(_photo(_spot(_wall(), 150, 220, radius)), [_front()])
    assert flare.category == "other"
    x0, y0, x1, y1 = flare.box
    assert x0 <= 150 - radius
    assert x1 > 150 + radius
    assert y0 <= 220 - radius
    assert y1 > 220 + radius
    assert flare.probability.shape == (y1 - y0, x1 - x0)
    assert flare.probability.sum() < 1.6 * np.pi * radius**2


def test_a_bright_wall_with_grain_is_no_flare() -> None:
    assert not flares(_photo(_wall(235)), [_front()])


def test_the_sky_beside_and_above_a_front_is_no_flare() -> None:
    assert not flares(_photo(_wall()), [_front()])


def test_a_spot_beside_every_front_is_left_alone() -> None:
    image = np.full((H, W), 100.0)
    assert not flares(_photo(_spot(image, 40, 50, 25)), [_front()])


def test_small_spots_and_bright_cornices_are_left_alone() -> None:
    image = _spot(_wall(), 150, 220, 6)
    image[120:128, 70:230] = 255
    image[300:312, 70:230] = 255
    assert not flares(_photo(image), [_front()])


def test_no_front_no_flare() -> None:
    image = _spot(_wall(), 150, 220, 30)
    person = Instance("person", 0.9, FRONT, _front().probability)
    assert not flares(_photo(image), [])
    assert not flares(_photo(image), [person])
