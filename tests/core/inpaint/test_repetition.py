import cv2
import numpy as np
import pytest

from nostalgin_core.inpaint.repetition import agreements, guess, shifted
from nostalgin_core.inpaint.resemblance import resemblance
from nostalgin_core.inpaint.smooth import fill, flow
from nostalgin_core.records import Box


def front(h: int, w: int, *, axis: int, floor: int) -> np.ndarray:
    """Paint windows on axes and floors, each with a blind of its own height."""
    y, x = np.mgrid[:h, :w]
    pane = (x % axis > axis // 3) & (y % floor > floor // 2)
    return np.where(pane, 60.0, 170.0).astype(np.float32)


@pytest.mark.parametrize(("axis", "floor"), [(20, 30), (27, 33), (31, 24)])
def test_axes_and_floors_are_found_again(axis: int, floor: int) -> None:
    image = front(200, 180, axis=axis, floor=floor)
    found, mirrored, rates = resemblance(image, np.ones(image.shape, bool), count=40)
    steps = np.abs(found[~mirrored]) / [axis, floor]
    assert len(steps) > 4
    assert (np.abs(steps - np.round(steps)) * [axis, floor]).max() < 1
    assert rates[0] > 0.9


def test_what_repeats_is_restored_where_a_membrane_knows_nothing() -> None:
    image = front(200, 180, axis=24, floor=32)
    hole = np.zeros(image.shape, bool)
    hole[60:150, 50:120] = True
    off = [
        np.abs(made - image)[hole].mean()
        for made in (guess(image, hole), fill(image, hole))
    ]
    assert off[0] < 0.1 * off[1]


def test_where_nothing_repeats_the_membrane_is_the_answer() -> None:
    y, x = np.mgrid[:90, :110].astype(np.float32)
    image = 100 + 0.3 * x + 0.2 * y
    hole = np.zeros(image.shape, bool)
    hole[30:60, 30:70] = True
    assert np.abs(guess(image, hole) - image)[hole].max() < 2


def test_known_texels_stay_and_hidden_ones_are_not_looked_at() -> None:
    rng = np.random.default_rng(0)
    image = front(120, 100, axis=20, floor=24)
    hole = rng.random(image.shape) < 0.3
    made = guess(image, hole)
    assert (made[~hole] == image[~hole]).all()
    other = np.where(hole, rng.uniform(0, 255, image.shape), image).astype(np.float32)
    assert (guess(other, hole) == made).all()


def test_a_front_larger_than_the_judged_size_is_restored_too() -> None:
    image = front(600, 640, axis=80, floor=100)
    hole = np.zeros(image.shape, bool)
    hole[250:400, 200:400] = True
    off = np.abs(guess(image, hole) - image)[hole].mean()
    assert off < 0.25 * np.abs(fill(image, hole) - image)[hole].mean()


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (7, 2), (3, 3)])
def test_tiny_and_wholly_hidden_fronts_are_filled(shape: tuple[int, int]) -> None:
    image = np.full(shape, 50, np.float32)
    assert np.isfinite(guess(image, np.ones(shape, bool))).all()
    hole = np.zeros(shape, bool)
    hole[0, 0] = True
    assert np.isfinite(guess(image, hole)).all()


def test_shifting_looks_up_at_the_offset() -> None:
    a = np.arange(12.0).reshape(3, 4)
    assert (shifted(a, np.array([1, 2]))[0] == [9, 10, 11, 0]).all()
    part = shifted(a, np.array([-1, 0]), Box(1, 1, 3, 3))
    assert (part == a[1:3, 0:2]).all()


def test_a_membrane_keeps_within_what_it_is_stretched_from() -> None:
    rng = np.random.default_rng(1)
    image = rng.uniform(20, 200, (70, 90)).astype(np.float32)
    hole = rng.random(image.shape) < 0.6
    made = fill(image, hole)
    assert made.min() >= image[~hole].min() - 1e-3
    assert made.max() <= image[~hole].max() + 1e-3


def test_a_membrane_over_a_plane_is_the_plane() -> None:
    y, x = np.mgrid[:64, :64].astype(np.float32)
    image = 2 * x + y
    hole = np.zeros(image.shape, bool)
    hole[20:40, 20:44] = True
    assert np.abs(fill(image, hole) - image).max() < 3


def portal(h: int, w: int) -> np.ndarray:
    """Paint a front that is its own mirror image and repeats nowhere."""
    rng = np.random.default_rng(3)
    half = cv2.resize(rng.integers(0, 200, (h // 12, w // 24), np.uint8), (w // 2, h))
    return np.hstack([half, half[:, ::-1]]).astype(np.float32)


def test_a_mirror_shows_what_is_hidden_on_one_side() -> None:
    image = portal(180, 168)
    hole = np.zeros(image.shape, bool)
    hole[60:120, 20:60] = True
    off = [
        np.abs(made - image)[hole].mean()
        for made in (guess(image, hole), fill(image, hole))
    ]
    assert off[0] < 0.3 * off[1]


def test_the_axis_of_a_symmetric_front_is_found_again() -> None:
    image = portal(180, 168)[:, 10:]  # 158 columns about the axis between 73 and 74
    found = resemblance(image, np.ones(image.shape, bool))
    assert found.mirrored[0]
    # Column x equals column 147 - x, which the mirror image shows at 157 - 147 + x.
    assert np.abs(found.offsets[0] - [10, 0]).max() < 1
    assert found.rates[0] > 0.9


def test_judging_a_box_alone_judges_it_as_the_whole_front_would() -> None:
    image = front(160, 150, axis=24, floor=32)
    hole = np.zeros(image.shape, bool)
    hole[100:160, 50:90] = True
    image = np.where(hole, 0, image).astype(np.float32)
    found = resemblance(image, ~hole)
    found = found._replace(offsets=np.round(found.offsets).astype(int))
    box, everything = Box(40, 90, 100, 160), Box(0, 0, 150, 160)
    part = agreements(image, ~hole, found, box)
    whole = agreements(image, ~hole, found, everything)
    for few, many in zip(part, whole, strict=True):
        for a, b in zip(few, many, strict=True):
            assert np.allclose(a, b[90:160, 40:100], atol=1e-3)


def test_a_smooth_fill_carries_an_edge_on_and_keeps_what_is_known() -> None:
    image = np.full((60, 80), 60, np.float32)
    image[:, 40:] = 180
    hole = np.zeros(image.shape, bool)
    hole[22:38, 30:50] = True
    made = flow(np.where(hole, 0, image).astype(np.float32), hole)
    assert (made[~hole] == image[~hole]).all()
    off = [np.abs(a - image)[hole].mean() for a in (made, fill(image, hole))]
    assert off[0] < 0.95 * off[1]
