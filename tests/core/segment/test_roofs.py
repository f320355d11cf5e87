import cv2
import numpy as np
import pytest

from nostalgin_core.records import Box, Instance, Photo
from nostalgin_core.segment.roofs import (
    cut,
    owners,
    roofs,
    straightened,
    without_walls_behind,
)
from nostalgin_core.segment.rows import NAMES, features

FRAME = Box(10, 8, 290, 408)
WHOLE = Box(70, 60, 230, 380)  # of the front and of the wall behind it
ROOF = 200


def _photo(*, blank: bool) -> Photo:
    """A front with rows of windows; above its roof a wall, blank or with windows."""
    rng = np.random.default_rng(0)
    image = np.full((416, 300), 235, np.uint8)
    image[60:380, 70:230] = 150
    if blank:
        image[60:ROOF, 70:230] = 95
        image[ROOF : ROOF + 4, 70:230] = 220
    for y in range(ROOF + 18 if blank else 78, 360, 36):
        for x in range(84, 220, 28):
            image[y : y + 20, x : x + 14] = 40
    noisy = image + rng.normal(0, 2, image.shape)
    return Photo("a photo", np.clip(noisy, 0, 255).astype(np.uint8), FRAME)


def _pixels(*, blank: bool) -> np.ndarray:
    """The branch's answer, which doubts the wall and sees an end at the roof."""
    pixels = np.zeros((4, 100, 70), np.float32)
    pixels[0] = 0.95
    rows, columns = slice(13, 93), slice(15, 55)
    pixels[1, rows, columns], pixels[0, rows, columns] = 0.95, 0.05
    if blank:
        above = slice(13, 48)
        pixels[1, above, columns], pixels[0, above, columns] = 0.35, 0.65
        pixels[3, 47:49, columns] = 0.9
    return pixels


def _thing(box: Box, category: str = "facade", score: float = 0.7) -> Instance:
    whole = np.ones((box.y1 - box.y0, box.x1 - box.x0), np.float32)
    return Instance(category, score, box, whole)  # type: ignore[arg-type]


def test_a_blank_wall_behind_a_low_front_is_cut_off_at_its_roof() -> None:
    things = (_thing(WHOLE), _thing(Box(100, 340, 130, 380), "person"))
    front, person = without_walls_behind(
        _photo(blank=True), things, _pixels(blank=True)
    )
    rows = np.flatnonzero(front.probability.any(1)) + WHOLE.y0
    assert abs(rows[0] - ROOF) <= 4
    assert rows[-1] == WHOLE.y1 - 1
    assert person is things[1]


def test_a_front_with_rows_up_to_its_roof_stays_whole() -> None:
    things = (_thing(WHOLE),)
    kept = without_walls_behind(_photo(blank=False), things, _pixels(blank=False))
    assert kept[0] is things[0]


def test_nothing_is_cut_where_there_is_no_front() -> None:
    things = (_thing(Box(100, 340, 130, 380), "person"),)
    assert roofs(_photo(blank=True), things, _pixels(blank=True)) == []


def test_a_finer_scan_ends_at_the_same_roof() -> None:
    coarse = _photo(blank=True)
    large = cv2.resize(coarse.image, None, fx=3, fy=3, interpolation=cv2.INTER_CUBIC)
    fine = Photo("finer", large, Box(*(3 * side for side in FRAME)))
    box = Box(*(3 * side for side in WHOLE))
    (front,) = without_walls_behind(fine, (_thing(box),), _pixels(blank=True))
    rows = np.flatnonzero(front.probability.any(1)) + box.y0
    assert abs(rows[0] / 3 - ROOF) <= 4


def test_a_cut_takes_what_lies_above_its_row_and_nothing_below() -> None:
    ((_, patch, _),) = straightened(
        _photo(blank=True), (_thing(WHOLE),), _pixels(blank=True)
    )
    for row in (20, 60, 100):
        left = cut(_thing(WHOLE), patch, row).probability > 0
        y, x = np.nonzero(left)
        points = np.stack([x + WHOLE.x0, y + WHOLE.y0, np.ones(len(x))])
        there = np.linalg.inv(patch.photo_from_patch) @ points
        assert (there[1] / there[2]).min() > row - 1
        assert left[-1].all()
        assert not left[0].any()


def test_a_pixel_is_the_likelier_fronts() -> None:
    first, second = _thing(Box(20, 20, 60, 60)), _thing(Box(40, 20, 90, 60), score=0.9)
    owner = owners((first, _thing(Box(30, 30, 50, 50), "person"), second), FRAME)
    assert owner[20, 20] == 0
    assert owner[20, 40] == 2
    assert owner[0, 0] == -1


@pytest.mark.parametrize("name", ["edge", "flat above", "upright edges above"])
def test_the_roof_of_a_low_front_stands_out(name: str) -> None:
    ((_, patch, shown),) = straightened(
        _photo(blank=True), (_thing(WHOLE),), _pixels(blank=True)
    )
    told, open_to = features(shown, 0.7)
    assert told.shape[1] == len(NAMES)
    assert np.isfinite(told).all()
    roof = np.array([150.0, ROOF, 1.0])
    there = np.linalg.inv(patch.photo_from_patch) @ roof
    row = round(there[1] / there[2])
    below = told[row + 30 : row + 90, NAMES.index(name)]
    near = told[row - 2 : row + 3, NAMES.index(name)]
    assert open_to[row]
    if name == "upright edges above":
        assert near.min() < 0.05 < below.max()
    else:
        assert near.max() > 0.8 > below.min()
