from collections.abc import Callable

import cv2
import numpy as np
import pytest

from export.rare_shapes import cornered, projecting
from export.segmentation_data import Sample, Thing, fill, truth
from nostalgin_core.arrays import Mask
from tests.export.painted_segmentation import painted, rectangle

SHAPE = (128, 128)
SEEDS = range(12)
CAR = 10
Kind = Callable[[Sample, np.random.Generator], Sample]


def house() -> Sample:
    """A front that darkens to its right and its foot, a neighbour, a car before it."""
    ys, xs = np.indices(SHAPE)
    image = np.full(SHAPE, 240, np.uint8)
    front = Thing("facade", rectangle(40, 30, 80, 110), 0, target=True)
    near = Thing("facade", rectangle(81, 50, 120, 110), 0)
    car = Thing("vehicle", rectangle(74, 100, 90, 116), 1)
    image[fill(front.rings, SHAPE)] = (200 - xs - ys // 2)[fill(front.rings, SHAPE)]
    image[fill(near.rings, SHAPE)] = 60
    image[fill(car.rings, SHAPE)] = CAR
    return Sample("house", image, (front, near, car))


def fronts(sample: Sample) -> list[Mask]:
    return [fill(t.rings, SHAPE) for t in sample.things if t.category == "facade"]


def grown(mask: Mask) -> Mask:
    return cv2.dilate(mask.astype(np.uint8), np.ones((7, 7), np.uint8)) > 0


@pytest.mark.parametrize("kind", [cornered, projecting])
@pytest.mark.parametrize("seed", SEEDS)
def test_what_is_built_hides_other_fronts_and_no_car(kind: Kind, seed: int) -> None:
    sample = house()
    after = kind(sample, np.random.default_rng(seed))
    assert after is not sample
    masks = fronts(after)
    assert np.sum(masks, axis=0).max() == 1  # each pixel is of one front
    changed = np.abs(after.image.astype(int) - sample.image) > 12
    assert changed.any()
    assert not (changed & ~grown(masks[-1])).any()
    core = cv2.erode(
        fill(sample.things[2].rings, SHAPE).astype(np.uint8), np.ones((7, 7))
    )
    assert (after.image[core > 0] == CAR).all()
    assert [t for t in after.things if t.layer] == [sample.things[2]]
    lost = np.any(fronts(sample), axis=0) & ~np.any(masks, axis=0)
    assert not lost.any()


def test_a_corners_second_front_is_its_first_ones_building_and_meets_it() -> None:
    for seed in SEEDS:
        sample = house()
        after = cornered(sample, np.random.default_rng(seed))
        assert len(fronts(after)) == 3
        wing = after.things[-1]
        near = wing.rings[0][0]
        first = next(
            t for t in sample.things[:2] if np.abs(t.rings[0] - near).max(1).min() <= 2
        )
        assert wing.target == first.target
        heights = np.ptp(wing.rings[0][[0, 3], 1]), np.ptp(wing.rings[0][[1, 2], 1])
        assert heights[1] < 0.9 * heights[0]
        assert np.ptp(first.rings[0][:, 1]) == pytest.approx(heights[0], abs=2)


def test_a_shop_that_stands_out_is_one_front_with_the_wall_above() -> None:
    for seed in SEEDS:
        sample = house()
        after = projecting(sample, np.random.default_rng(seed))
        assert len(fronts(after)) == 2
        whole = fronts(after)[-1]
        old = next(m for m in fronts(sample) if (m & whole).sum() > 0.9 * m.sum())
        assert not (old & ~whole).any()
        rows = np.flatnonzero(whole.any(1))
        widths = whole[rows].sum(1)
        assert widths[-3] > widths[2]
        kept = rows[: len(rows) // 2]
        np.testing.assert_array_equal(after.image[kept], sample.image[kept])


@pytest.mark.parametrize("kind", [cornered, projecting])
def test_a_front_that_is_no_quad_or_mostly_hidden_is_left(kind: Kind) -> None:
    triangle = Thing(
        "facade", (np.array([(20, 110), (100, 110), (100, 20)], float),), 0
    )
    image = np.full(SHAPE, 128, np.uint8)
    odd = Sample("odd", image, (triangle,))
    assert kind(odd, np.random.default_rng(0)) is odd
    front = Thing("facade", rectangle(40, 30, 80, 110), 0)
    fence = Thing("other", rectangle(38, 28, 82, 112), 1)
    behind = Sample("behind", image, (front, fence))
    assert kind(behind, np.random.default_rng(0)) is behind


@pytest.mark.parametrize("kind", [cornered, projecting])
@pytest.mark.parametrize("seed", SEEDS)
def test_labels_stay_such_as_can_be_trained_on(kind: Kind, seed: int) -> None:
    answer = truth(kind(painted(seed), np.random.default_rng(seed)))
    assert (answer.boxes[:, 2:] > answer.boxes[:, :2]).all()
    assert not (answer.masks.sum(0) > 1).any()
