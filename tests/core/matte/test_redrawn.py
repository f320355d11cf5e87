"""A front that somebody drew is the front, and its neighbours keep theirs."""

import numpy as np
import pytest

from nostalgin_core import matte, photo
from nostalgin_core.arrays import Points
from nostalgin_core.records import Box, Instance, Matted, Photo, Rejection
from tests.pipelines import painted


@pytest.fixture(scope="module")
def picture() -> Photo:
    found = photo.decode(painted.photo(), name="painted")
    assert isinstance(found, Photo)
    return found


def instances(*quads: np.ndarray) -> tuple[Instance, ...]:
    found = []
    for quad in quads:
        x0, y0 = np.floor(quad.min(axis=0)).astype(int)
        x1, y1 = np.ceil(quad.max(axis=0)).astype(int)
        box = Box(int(x0), int(y0), int(x1), int(y1))
        sure = np.full((box.y1 - box.y0, box.x1 - box.x0), 0.98, np.float32)
        found.append(Instance("facade", 0.9, box, sure))
    car = Box(*painted.CAR)
    hidden = np.full((car.y1 - car.y0, car.x1 - car.x0), 0.95, np.float32)
    return (*found, Instance("vehicle", 0.8, car, hidden))


BOTH = instances(painted.LEFT, painted.RIGHT)
OUTLINE = np.array([[60, 120], [250, 160], [250, 540], [60, 580]], np.float64)


def made(picture: Photo, found: tuple[Instance, ...], outline: Points) -> Matted:
    result = matte.redrawn(picture, found, outline)
    assert isinstance(result, Matted)
    return result


def test_the_front_is_what_was_drawn_and_what_hides_it_is_taken_off(
    picture: Photo,
) -> None:
    (own,) = [one for one in made(picture, BOTH, OUTLINE).facades if one.target]
    ys, xs = np.nonzero(own.amodal)
    assert (xs.min(), xs.max(), ys.min(), ys.max()) == (60, 250, 120, 580)
    polygon = 0.5 * (460 + 380) * 190
    assert abs(np.count_nonzero(own.amodal) - polygon) < 0.01 * polygon
    x0, y0, x1, y1 = painted.CAR
    assert not own.mask[y0:y1, x0:x1].any()
    assert own.alpha[y0 + 6 : y1 - 6, x0 + 6 : x1 - 6].max() < 0.1
    assert own.alpha[200:500, 80:230].min() > 0.95
    assert not own.alpha[~own.amodal & (np.arange(640)[:, None] < 110)].any()


def test_neighbours_keep_what_is_not_drawn_and_their_order(picture: Photo) -> None:
    wide = OUTLINE + np.array([[0, 0], [60, 0], [60, 0], [0, 0]])
    before = matte.matte(picture, BOTH)
    assert isinstance(before, Matted)
    after = made(picture, BOTH, wide)
    left, right = after.facades
    assert (left.index, left.target, right.index, right.target) == (0, True, 1, False)
    assert not (right.amodal & left.amodal).any()
    assert np.array_equal(right.amodal, before.facades[1].amodal & ~left.amodal)


def test_the_front_most_like_the_drawing_gives_way(picture: Photo) -> None:
    right = painted.RIGHT.astype(np.float64) + 5
    facades = made(picture, BOTH, right).facades
    assert [one.target for one in facades] == [False, True]
    assert len(facades) == 2


def test_where_no_front_was_found_the_drawn_one_stands_alone(picture: Photo) -> None:
    (only,) = made(picture, (), OUTLINE).facades
    assert only.target
    assert only.target_score == 1.0
    assert only.alpha[300, 150] == 1.0


def test_a_front_that_is_mostly_drawn_over_is_dropped(picture: Photo) -> None:
    sliver = np.array([[70, 200], [120, 200], [120, 500], [70, 500]], np.float32)
    facades = made(picture, instances(painted.LEFT, sliver), OUTLINE).facades
    assert len(facades) == 1


def test_an_outline_beyond_the_frame_is_rejected(picture: Photo) -> None:
    result = matte.redrawn(picture, BOTH, OUTLINE + 5000)
    assert isinstance(result, Rejection)
    assert result.reason == "outline beyond the frame"
