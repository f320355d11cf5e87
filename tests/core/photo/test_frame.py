import cv2
import numpy as np
import pytest

from nostalgin_core.photo import frame
from nostalgin_core.records import Box
from nostalgin_core.scenes import film
from tests.data import DATA, needs_data


def _street(h: int = 420, w: int = 280, *, seed: int = 0) -> np.ndarray:
    """A bright picture of blocks of gray, whatever that may show."""
    rng = np.random.default_rng(seed)
    small = rng.integers(80, 230, (h // 14, w // 14)).astype(np.uint8)
    return cv2.resize(small, (w, h), interpolation=cv2.INTER_NEAREST)


def _bordered(margins: tuple[int, int, int, int], *, level: int = 6) -> np.ndarray:
    """A street on film: `margins` of border left, above, right and below."""
    left, above, right, below = margins
    film = np.full((420, 280), level, np.uint8)
    inside = np.s_[above : 420 - below, left : 280 - right]
    film[inside] = _street()[inside]
    noise = np.random.default_rng(1).integers(0, 6, film.shape)
    return (film + noise).astype(np.uint8)


@pytest.mark.parametrize("margins", [(9, 12, 5, 14), (0, 12, 0, 0), (3, 0, 20, 6)])
@pytest.mark.parametrize("level", [0, 45])
def test_the_border_ends_where_the_picture_begins(
    margins: tuple[int, int, int, int], level: int
) -> None:
    left, above, right, below = margins
    found = frame.exposed(_bordered(margins, level=level))
    assert found == Box(left, above, 280 - right, 420 - below)


def test_a_picture_without_border_is_kept_whole() -> None:
    assert frame.exposed(_street()) == Box(0, 0, 280, 420)


def test_a_night_sky_is_no_border() -> None:
    night = _street()
    night[:120] = 3
    assert frame.exposed(night) == Box(0, 0, 280, 420)


def test_a_dark_wall_with_lit_windows_is_no_border() -> None:
    wall = _street()
    wall[:, :15] //= 8
    wall[::3, :15] = 90
    assert frame.exposed(wall) == Box(0, 0, 280, 420)


def test_a_black_picture_is_kept_whole() -> None:
    assert frame.exposed(np.zeros((100, 80), np.uint8)) == Box(0, 0, 80, 100)


def test_a_sliver_of_the_next_frame_is_cut_off_too() -> None:
    film = _bordered((0, 12, 0, 0))
    film[:2] = 190
    assert frame.exposed(film) == Box(0, 12, 280, 420)


def test_a_frame_turned_by_half_a_degree_is_found_within_its_slant() -> None:
    film = _bordered((9, 12, 9, 12))
    turn = cv2.getRotationMatrix2D((140, 210), 0.5, 1.0)
    turned = cv2.warpAffine(film, turn, (280, 420), borderValue=6)
    found = np.array(frame.exposed(turned))
    np.testing.assert_allclose(found, (9, 12, 271, 408), atol=2)


def test_turning_the_photo_turns_the_frame() -> None:
    film = _bordered((9, 12, 5, 14))
    x0, y0, x1, y1 = frame.exposed(film)
    assert frame.exposed(np.ascontiguousarray(film[::-1, ::-1])) == Box(
        280 - x1, 420 - y1, 280 - x0, 420 - y0
    )


@needs_data
def test_tax_photographs_have_a_border_and_lose_little_to_it() -> None:
    shares, sides = [], []
    for path in sorted((DATA / "taxphotos" / "photos").glob("*.jpg"))[::4]:
        image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
        h, w = image.shape
        x0, y0, x1, y1 = frame.exposed(image)
        shares.append((x1 - x0) * (y1 - y0) / (h * w))
        sides.append(sum((x0 > 0, y0 > 0, x1 < w, y1 < h)))
    assert min(shares) > 0.9
    assert min(sides) >= 1
    assert np.mean(sides) > 3


@needs_data
def test_prints_with_cut_margins_hardly_ever_have_one() -> None:
    found = 0
    paths = sorted((DATA / "historic_streets" / "photos").glob("*.jpg"))[::15]
    for path in paths:
        image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
        found += frame.exposed(image) != Box(0, 0, *image.shape[::-1])
    assert found <= 0.1 * len(paths)


@pytest.mark.parametrize("seed", range(4))
def test_the_painted_film_border_is_found(seed: int) -> None:
    rng = np.random.default_rng(seed)
    box, inside = film.exposed(rng, (420, 280))
    light = _street(seed=seed).astype(np.float32)
    found = frame.exposed(film.develop(rng, light, inside))
    np.testing.assert_allclose(found, box, atol=1)
