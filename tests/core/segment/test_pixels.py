import numpy as np
import pytest

from nostalgin_core.records import Box, Instance
from nostalgin_core.segment.pixels import DOUBT, mended, pool

FRAME = Box(20, 10, 180, 138)  # 160 x 128: 40 x 32 cells of 4
ROWS, COLUMNS = 32, 40
EVEN = 1.0  # a prior that says nothing


def _plane(
    value: float, *, rows: slice = slice(0), columns: slice = slice(0)
) -> np.ndarray:
    plane = np.full((ROWS, COLUMNS), 0.02, np.float32)
    plane[rows, columns] = value
    return plane


def _pixels(front: np.ndarray, hiding: np.ndarray) -> np.ndarray:
    ground = np.clip(1 - front - hiding, 0, 1)
    return np.stack([ground, front, hiding, np.zeros_like(front)]).astype(np.float32)


def _thing(category: str, box: Box, value: float = 0.98) -> Instance:
    shape = (box.y1 - box.y0, box.x1 - box.x0)
    return Instance(category, 0.9, box, np.full(shape, value, np.float32))  # pyright: ignore[reportArgumentType]


def _grid() -> tuple[np.ndarray, np.ndarray]:
    sure = np.linspace(DOUBT, 1 - DOUBT, 25, dtype=np.float32)
    mask, pixel = np.meshgrid(sure, sure)
    return mask, pixel


@pytest.mark.parametrize("weight", [0.0, 0.25, 0.5, 1.0])
def test_witnesses_who_agree_are_believed_as_they_are(weight: float) -> None:
    mask, _ = _grid()
    np.testing.assert_allclose(pool(mask, mask, weight=weight), mask, atol=1e-5)


def test_a_witness_with_all_the_weight_speaks_alone() -> None:
    mask, pixel = _grid()
    np.testing.assert_allclose(pool(mask, pixel, weight=0.0), mask, atol=1e-5)
    np.testing.assert_allclose(pool(mask, pixel, weight=1.0), pixel, atol=1e-5)


def test_what_is_believed_of_a_thing_is_doubted_of_its_opposite() -> None:
    mask, pixel = _grid()
    told = pool(mask, pixel, weight=0.7, prior=2.0)
    opposite = pool(1 - mask, 1 - pixel, weight=0.7, prior=0.5)
    np.testing.assert_allclose(told + opposite, 1, atol=1e-5)


def test_a_likelier_witness_makes_it_likelier_and_so_does_a_prior() -> None:
    mask, pixel = _grid()
    told = pool(mask, pixel, weight=0.5)
    assert (np.diff(told, axis=0) > 0).all()
    assert (np.diff(told, axis=1) > 0).all()
    assert (pool(mask, pixel, weight=0.5, prior=1.5) > told).all()


def test_pixels_that_see_what_masks_see_leave_them() -> None:
    box = Box(40, 30, 120, 110)
    front = _plane(0.98, rows=slice(5, 25), columns=slice(5, 25))
    (one,) = mended([_thing("facade", box)], _pixels(front, _plane(0)), FRAME)
    assert one.box == box
    inner = one.probability[8:-8, 8:-8]
    np.testing.assert_allclose(inner, 0.98, atol=1e-3)


def test_pixels_take_off_a_front_what_is_none() -> None:
    box = Box(40, 30, 120, 110)
    front = _plane(0.98, rows=slice(5, 25), columns=slice(5, 15))
    (one,) = mended([_thing("facade", box, 0.9)], _pixels(front, _plane(0)), FRAME)
    assert (one.probability[:, :32] > 0.5).all()
    assert (one.probability[:, 48:] < 0.5).all()


def test_neighbours_share_as_before() -> None:
    left, right = Box(30, 30, 110, 110), Box(90, 30, 170, 110)
    things = [_thing("facade", left, 0.9), _thing("facade", right, 0.6)]
    front = _plane(0.95, rows=slice(0, ROWS), columns=slice(0, COLUMNS))
    one, two = mended(things, _pixels(front, _plane(0)), FRAME)
    shared_one, shared_two = one.probability[:, 60:], two.probability[:, :20]
    np.testing.assert_allclose(shared_two / shared_one, 0.6 / 0.9, rtol=1e-4)
    assert shared_one.min() > 0.9


def test_what_only_pixels_see_before_fronts_becomes_a_thing() -> None:
    hiding = _plane(0.97, rows=slice(20, 28), columns=slice(10, 20))
    front = _thing("facade", Box(40, 30, 120, 110))
    seen = _plane(0.98, rows=slice(5, 20), columns=slice(5, 25))
    _, other = mended([front], _pixels(seen, hiding), FRAME)
    assert other.category == "other"
    want = np.array([20 + 40, 10 + 80, 20 + 80, 10 + 112])
    assert np.abs(np.array(other.box) - want).max() <= 2
    assert other.score == pytest.approx(other.probability[other.probability > 0].mean())
    assert other.score > 0.5


def test_what_a_thing_covers_makes_no_second_one() -> None:
    hiding = _plane(0.97, rows=slice(20, 28), columns=slice(10, 20))
    car = _thing("vehicle", Box(56, 86, 104, 126), 0.9)
    (only,) = mended([car], _pixels(_plane(0), hiding), FRAME)
    assert only.category == "vehicle"
    assert only.box == car.box


def test_a_crumb_is_no_thing_and_a_board_stays_what_it_is() -> None:
    crumb = _plane(0.97, rows=slice(20, 21), columns=slice(10, 11))
    assert mended([], _pixels(_plane(0), crumb), FRAME) == ()
    board = _thing("placard", Box(60, 90, 100, 122))
    hiding = _plane(0.97, rows=slice(20, 28), columns=slice(10, 20))
    (only,) = mended([board], _pixels(_plane(0), hiding), FRAME)
    assert only is board


def test_nothing_leaves_zero_to_one_or_the_frame() -> None:
    rng = np.random.default_rng(0)
    kinds = rng.dirichlet(np.ones(3), (ROWS, COLUMNS)).transpose(2, 0, 1)
    pixels = np.concatenate([kinds, kinds[:1]]).astype(np.float32)
    boxes = [Box(20, 10, 90, 138), Box(60, 40, 180, 100), Box(100, 90, 140, 138)]
    things = [
        _thing(kind, box, float(rng.random()))
        for kind, box in zip(("facade", "facade", "person"), boxes, strict=True)
    ]
    for one in mended(things, pixels, FRAME):
        assert one.probability.dtype == np.float32
        assert 0 <= one.probability.min() <= one.probability.max() <= 1
        x0, y0, x1, y1 = one.box
        assert FRAME.x0 <= x0 < x1 <= FRAME.x1
        assert FRAME.y0 <= y0 < y1 <= FRAME.y1
        assert one.probability.shape == (y1 - y0, x1 - x0)
