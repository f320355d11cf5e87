import cv2
import numpy as np
import pytest

from nostalgin_core.measure.segmentation import overlap
from nostalgin_core.photo import photo
from nostalgin_core.records import Box, Photo, Rejection
from nostalgin_core.segment.punch import healed, punches
from tests.data import DATA, needs_data

H, W = 420, 300


def _photo(image: np.ndarray) -> Photo:
    return Photo("0" * 16, image.astype(np.uint8), Box(10, 10, W - 10, H - 10))


def _street() -> np.ndarray:
    """A gray street with grain, a black doorway, a dark window and a black border."""
    image = np.random.default_rng(5).normal(110, 12, (H, W))
    image[200:300, 60:110] = 3
    image[100:130, 200:240] = 8
    image = cv2.GaussianBlur(image, (0, 0), 1.0)
    rim = np.ones((H, W), bool)
    rim[10:-10, 10:-10] = False
    image[rim] = 0
    return np.clip(image, 0, 255).astype(np.uint8)


@pytest.mark.parametrize(("level", "letter"), [(2, 90), (253, 200)])
@pytest.mark.parametrize("radius", [18, 30])
@pytest.mark.parametrize("centre", [(150, 60), (200, 330)])
def test_a_black_or_white_disc_is_a_hole_and_covered_whole(
    level: int, letter: int, radius: int, centre: tuple[int, int]
) -> None:
    disc = cv2.circle(np.zeros((H, W), np.uint8), centre, radius, 1, -1)
    image = np.where(disc > 0, np.uint8(level), _street())
    cv2.putText(image, "NYC", centre, cv2.FONT_HERSHEY_PLAIN, 0.8, letter)
    (hole,) = punches(_photo(image))
    assert hole.category == "other"
    x0, y0, x1, y1 = hole.box
    found = np.zeros((H, W), bool)
    found[y0:y1, x0:x1] = hole.probability > 0.5
    assert (disc > 0)[found].sum() == disc.sum()
    assert found.sum() < 1.4 * disc.sum()


def test_doors_windows_and_the_film_border_are_no_holes() -> None:
    assert not punches(_photo(_street()))


def test_a_gray_disc_and_a_small_one_are_left_alone() -> None:
    street = _street()
    assert not punches(_photo(cv2.circle(street.copy(), (200, 330), 30, 70, -1)))
    assert not punches(_photo(cv2.circle(street.copy(), (200, 330), 9, 2, -1)))


def test_a_disc_that_runs_into_a_shadow_is_left_alone() -> None:
    image = cv2.circle(_street(), (150, 330), 30, 2, -1)
    image[330:380, 100:200] = 2
    assert not punches(_photo(image))


def test_a_healed_hole_has_the_tones_round_it_and_the_rest_is_untouched() -> None:
    disc = cv2.circle(np.zeros((H, W), np.uint8), (200, 330), 30, 1, -1) > 0
    holed = _photo(np.where(disc, np.uint8(2), _street()))
    mended = healed(holed, punches(holed))
    assert abs(float(mended[disc].mean()) - 110) < 8
    near = cv2.dilate(disc.astype(np.uint8), np.ones((7, 7), np.uint8)) > 0
    np.testing.assert_array_equal(mended[~near], holed.image[~near])


def test_a_photo_without_holes_is_its_own_healed_one() -> None:
    whole = _photo(_street())
    assert healed(whole, punches(whole)) is whole.image


# Of all 363 labelled photographs these bear a whole punched hole.
PUNCHED = ("0030a", "0030b", "0032", "0033", "0034", "0035")


@needs_data
def test_six_holes_of_block_997_are_found_and_nothing_else() -> None:
    folder = DATA / "taxphotos" / "photos"
    found = {}
    for file in sorted(folder.glob("*00997_003*.jpg")):
        decoded = photo.decode(file.read_bytes(), name=file.name)
        assert not isinstance(decoded, Rejection)
        for hole in punches(decoded):
            found[file.stem.split("00997_")[-1]] = hole
    assert tuple(found) == PUNCHED
    labelled = cv2.ellipse(
        np.zeros((840, 560), np.uint8), ((455.7, 742.5), (104.6, 104.6), 0), 1, -1
    )
    x0, y0, x1, y1 = found["0034"].box
    mask = np.zeros((840, 560), bool)
    mask[y0:y1, x0:x1] = found["0034"].probability > 0.5
    assert overlap(mask, labelled > 0) > 0.9
