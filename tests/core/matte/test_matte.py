import cv2
import numpy as np
import pytest

from nostalgin_core import matte
from nostalgin_core.matte import facade
from nostalgin_core.records import Box, Instance, Matted, Photo, Rejection

H, W = 240, 320
FRAME = Box(6, 5, W - 4, H - 7)


def _rectangle(x0: int, y0: int, x1: int, y1: int) -> np.ndarray:
    mask = np.zeros((H, W), np.float32)
    mask[y0:y1, x0:x1] = 1.0
    return mask


LEFT = _rectangle(40, 60, 150, 200)
RIGHT = _rectangle(150, 40, 270, 200)
CAR = _rectangle(90, 160, 190, 215)


def _found(category: str, true: np.ndarray, *, off_px: int = 3) -> Instance:
    """What a network makes of a mask: soft, coarse, and a few pixels off."""
    moved = np.roll(true, off_px, axis=(0, 1))
    blurred = cv2.GaussianBlur(moved, (0, 0), 4.0)
    ys, xs = np.nonzero(blurred > 0.01)
    box = Box(int(xs.min()), int(ys.min()), int(xs.max()) + 1, int(ys.max()) + 1)
    part = np.ascontiguousarray(blurred[box.y0 : box.y1, box.x0 : box.x1])
    return Instance(category, 0.9, box, part)


def _photo() -> Photo:
    """Two fronts of different gray before a pale sky, and a dark car before both."""
    image = np.full((H, W), 205.0)
    for mask, level in ((LEFT, 120), (RIGHT, 165), (CAR, 30)):
        image[mask > 0] = level
    image += np.random.default_rng(5).normal(0, 2, image.shape)
    image = cv2.GaussianBlur(image, (0, 0), 0.7)
    return Photo("0" * 16, np.clip(image, 0, 255).astype(np.uint8), FRAME)


@pytest.fixture(scope="module")
def matted() -> Matted:
    result = matte.matte(
        _photo(),
        (_found("facade", LEFT), _found("facade", RIGHT), _found("vehicle", CAR)),
    )
    assert isinstance(result, Matted)
    return result


def test_outlines_move_to_the_edges_that_the_camera_saw(matted: Matted) -> None:
    found = [_found("facade", LEFT), _found("facade", RIGHT), _found("vehicle", CAR)]
    arranged = facade.arrange(_photo(), found)
    assert not isinstance(arranged, Rejection)
    for front, said, true in zip(matted.facades, arranged, (LEFT, RIGHT), strict=True):
        visible = (true > 0) & (CAR == 0)
        wrong = (front.alpha > 0.5) ^ visible
        before = said.mask ^ visible
        assert wrong.sum() < 0.35 * before.sum()
        assert np.abs(front.alpha - visible).mean() < 0.5 * before.mean()


def test_what_stands_before_a_front_is_taken_off(matted: Matted) -> None:
    core = cv2.erode(CAR, np.ones((9, 9))) > 0
    for front in matted.facades:
        assert front.alpha[core].max() < 0.5


def test_hardly_a_trace_is_left_of_what_stands_before_a_front(matted: Matted) -> None:
    core = cv2.erode(CAR, np.ones((9, 9))) > 0
    for front in matted.facades:
        assert (front.alpha[core] > 0.1).mean() < 0.01


def test_neighbours_share_a_pixel_but_never_more_than_one(matted: Matted) -> None:
    total = np.sum([front.alpha for front in matted.facades], axis=0)
    assert total.max() <= 1 + 1e-5
    wall = cv2.erode(LEFT + RIGHT - CAR, np.ones((13, 13))) > 0.9
    assert total[wall].min() > 0.7


def test_neighbours_do_not_leak_into_each_other(matted: Matted) -> None:
    left, right = matted.facades
    assert left.alpha[:, 160:].max() < 0.1
    assert right.alpha[:, :140].max() < 0.1


def test_the_film_border_belongs_to_nobody() -> None:
    wide = _rectangle(0, 0, W, 200)
    result = matte.matte(_photo(), (_found("facade", wide, off_px=0),))
    assert isinstance(result, Matted)
    alpha = result.facades[0].alpha
    x0, y0, x1, y1 = FRAME
    assert alpha[y0:190, x0:x1].min() > 0.9
    alpha = alpha.copy()
    alpha[y0:y1, x0:x1] = 0
    assert alpha.max() == 0


def test_occluders_keep_their_kind_and_get_sharp_outlines(matted: Matted) -> None:
    (car,) = matted.occluders
    assert car.category == "vehicle"
    near = (LEFT + RIGHT) > 0
    assert ((car.mask ^ (CAR > 0)) & near).sum() < 0.08 * CAR.sum()


def test_the_same_photo_gives_the_same_bytes(matted: Matted) -> None:
    again = matte.matte(
        _photo(),
        (_found("facade", LEFT), _found("facade", RIGHT), _found("vehicle", CAR)),
    )
    for one, two in zip(matted.facades, again.facades, strict=True):
        assert one.alpha.tobytes() == two.alpha.tobytes()


def test_a_photo_whose_fronts_are_all_lost_is_refused() -> None:
    speck = _found("facade", _rectangle(50, 50, 54, 54))
    result = matte.matte(_photo(), (speck,))
    assert isinstance(result, Rejection)
    assert result.detail
