import numpy as np
import pytest

from nostalgin_core.records import Box, Instance, Photo
from nostalgin_core.segment.walls import NAMES, before, features, planes, without_walls

FRAME = Box(10, 8, 250, 328)
FRONT, WALL = Box(30, 60, 110, 260), Box(130, 60, 230, 260)


def _photo() -> Photo:
    """A front with windows beside a blank wall, under a bright sky."""
    image = np.full((336, 260), 230, np.uint8)
    image[60:260, 30:110] = 150
    for y in range(75, 240, 30):
        for x in range(40, 100, 20):
            image[y : y + 16, x : x + 10] = 40
    image[60:260, 130:230] = 120
    return Photo("a photo", image, FRAME)


def _pixels(wall: float) -> np.ndarray:
    """The branch's answer, which gives the blank wall some chance of being front."""
    pixels = np.zeros((4, 80, 60), np.float32)
    pixels[0] = 0.95
    for box, front in ((FRONT, 0.9), (WALL, wall)):
        rows = slice((box.y0 - FRAME.y0) // 4, (box.y1 - FRAME.y0) // 4)
        columns = slice((box.x0 - FRAME.x0) // 4, (box.x1 - FRAME.x0) // 4)
        pixels[1, rows, columns] = front
        pixels[0, rows, columns] = 1 - front
    return pixels


def _thing(box: Box, category: str = "facade", score: float = 0.6) -> Instance:
    whole = np.ones((box.y1 - box.y0, box.x1 - box.x0), np.float32)
    return Instance(category, score, box, whole)  # type: ignore[arg-type]


def test_a_blank_wall_that_the_branch_doubts_goes_and_a_front_stays() -> None:
    things = (_thing(WALL), _thing(FRONT), _thing(Box(60, 240, 90, 280), "person"))
    kept = without_walls(_photo(), things, _pixels(0.25))
    assert [one.box for one in kept] == [FRONT, Box(60, 240, 90, 280)]


def test_what_the_branch_takes_for_front_stays_even_without_windows() -> None:
    things = (_thing(WALL, score=0.9), _thing(FRONT))
    assert without_walls(_photo(), things, _pixels(0.9)) == things


def test_what_is_wholly_hidden_is_not_judged() -> None:
    things = (_thing(WALL), _thing(WALL, "vegetation"))
    assert without_walls(_photo(), things, _pixels(0.25)) == things


@pytest.mark.parametrize(("x", "y"), [(0, 0), (17, 31)])
def test_features_do_not_depend_on_where_the_frame_lies(x: int, y: int) -> None:
    photo, pixels = _photo(), _pixels(0.25)
    shifted = Photo(
        photo.key,
        np.pad(photo.image, ((y, 0), (x, 0))),
        Box(FRAME.x0 + x, FRAME.y0 + y, FRAME.x1 + x, FRAME.y1 + y),
    )
    there = Box(FRONT.x0 + x, FRONT.y0 + y, FRONT.x1 + x, FRONT.y1 + y)
    one, other = (
        features(_thing(box), planes(p, pixels), before((), p.frame), p.frame)
        for p, box in ((photo, FRONT), (shifted, there))
    )
    np.testing.assert_allclose(one, other)
    assert len(one) == len(NAMES)


def test_windows_are_edges_and_blank_walls_are_flat() -> None:
    seen, hidden = planes(_photo(), _pixels(0.25)), before((), FRAME)
    front, wall = (
        dict(zip(NAMES, features(_thing(box), seen, hidden, FRAME), strict=True))
        for box in (FRONT, WALL)
    )
    assert front["upright edges"] > 0.05
    assert wall["upright edges"] < front["upright edges"]
    assert wall["flat"] > 0.5 > front["flat"]
