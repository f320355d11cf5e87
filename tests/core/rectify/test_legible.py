from dataclasses import replace

import cv2
import numpy as np
import pytest

from nostalgin_core import evidence, homography
from nostalgin_core.records import Elevation
from nostalgin_core.rectify import sharpness, stretched

H, W = 90, 120
EDGES = np.array([[0.0, 0.0], [W, 0.0], [W, H], [0.0, H]])


def seen(quad: np.ndarray, image: np.ndarray | None = None) -> Elevation:
    noise = np.random.default_rng(1).integers(0, 255, (H, W), dtype=np.uint8)
    image = noise if image is None else image
    return Elevation(
        facade=0,
        image=image,
        alpha=np.ones(image.shape, np.float32),
        evidence=np.full(image.shape, evidence.PHOTOGRAPHED, np.uint8),
        quad=quad,
        photo_from_elevation=homography.between(EDGES, quad),
        vanishing_points=np.zeros((2, 3)),
        focal_px=None,
        aspect=W / H,
        vanishing_sd_deg=(1.0, 1.0),
        focal_sd_px=None,
        aspect_sd=0.01,
        method="",
    )


@pytest.mark.parametrize("across", [1.0, 0.5, 0.36])
def test_a_front_narrowed_less_than_thrice_is_not_stretched(across: float) -> None:
    assert stretched(seen(EDGES * [across, 1.0])) == 0.0


@pytest.mark.parametrize("across", [0.3, 0.1])
@pytest.mark.parametrize("turned", [False, True])
def test_a_front_narrowed_more_than_thrice_is(across: float, *, turned: bool) -> None:
    quad = EDGES * [across, 1.0]
    assert stretched(seen(quad[:, ::-1] if turned else quad)) == 1.0


def test_of_a_receding_front_the_far_part_is_stretched() -> None:
    quad = np.array([[0.0, 0.0], [30.0, 30.0], [30.0, 60.0], [0.0, 90.0]])
    share = stretched(seen(quad))
    assert 0.2 < share < 1.0
    hidden = seen(quad)
    hidden.evidence[:, W // 2 :] = evidence.INPAINTED
    assert stretched(hidden) < share


def test_a_blurred_front_has_less_detail_and_a_pale_one_too() -> None:
    sharp = seen(EDGES)
    blurred = cv2.GaussianBlur(sharp.image, (0, 0), 3.0)
    pale = (sharp.image // 4 + 90).astype(np.uint8)
    assert sharpness(replace(sharp, image=blurred), 1.0 * H * W) < 0.3 * sharpness(
        sharp, 1.0 * H * W
    )
    assert sharpness(replace(sharp, image=pale), 1.0 * H * W) < 0.3 * sharpness(
        sharp, 1.0 * H * W
    )


def test_magnifying_adds_no_detail() -> None:
    small = seen(EDGES)
    large = cv2.resize(small.image, (3 * W, 3 * H), interpolation=cv2.INTER_CUBIC)
    assert sharpness(seen(EDGES, large), 1.0 * H * W) == pytest.approx(
        sharpness(small, 1.0 * H * W), rel=0.35
    )


def test_what_nobody_saw_has_no_detail() -> None:
    blind = seen(EDGES)
    blind.evidence[:] = evidence.INPAINTED
    assert sharpness(blind, 0.0) == 0.0
    assert stretched(blind) == 0.0


def test_a_sliver_of_a_few_pixels_is_looked_at_no_coarser_than_a_small_front() -> None:
    sliver = seen(EDGES)
    assert sharpness(sliver, 0.5) == sharpness(sliver, H * W / 16.0)
