import cv2
import numpy as np
import pytest

from nostalgin_core.photo import frame
from nostalgin_core.records import Box
from nostalgin_core.scenes import film
from tests.data import DATA, needs_data

PRINTS = {  # of historic_streets, all on paper
    "723726f-a": Box(37, 38, 532, 401),
    "733246f-c": Box(40, 33, 572, 342),
    "729327f-b": Box(50, 0, 544, 348),  # whose sky is as light as its paper
    "708448f-b": Box(57, 0, 520, 404),
}


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
def test_prints_hardly_ever_have_a_film_border() -> None:
    found = 0
    paths = sorted((DATA / "historic_streets" / "photos").glob("*.jpg"))[::15]
    for path in paths:
        image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
        found += frame.filmed(image) != Box(0, 0, *image.shape[::-1])
    assert found <= 0.1 * len(paths)


def _printed(
    margins: tuple[int, int, int, int], *, tone: int = 222, sky: int = 0
) -> np.ndarray:
    """A street on paper: `margins` of it left, above, right and below."""
    left, above, right, below = margins
    print_ = np.full((420, 280), tone, np.uint8)
    inside = np.s_[above : 420 - below, left : 280 - right]
    print_[inside] = np.minimum(_street()[inside], tone - 40)
    if sky:
        print_[above : above + 90, left : 280 - right] = sky
    grain = np.random.default_rng(2).integers(0, 6, print_.shape)
    return (print_ + grain).astype(np.uint8)


@pytest.mark.parametrize(
    "margins", [(9, 12, 10, 14), (20, 30, 18, 110), (9, 0, 10, 14), (9, 12, 0, 60)]
)
@pytest.mark.parametrize("tone", [170, 245])
def test_paper_round_a_print_is_cut_off(
    margins: tuple[int, int, int, int], tone: int
) -> None:
    left, above, right, below = margins
    found = frame.exposed(_printed(margins, tone=tone))
    assert found == Box(left, above, 280 - right, 420 - below)


def test_a_captions_letters_are_paper_too() -> None:
    card = _printed((12, 14, 12, 60))
    cv2.putText(card, "BROADWAY AT 34", (70, 395), cv2.FONT_HERSHEY_SIMPLEX, 0.5, 40)
    assert frame.exposed(card) == Box(12, 14, 268, 360)


def test_paper_that_a_light_sky_hides_is_cut_off_the_other_sides() -> None:
    found = frame.exposed(_printed((10, 12, 10, 12), sky=222))
    assert found == Box(10, 0, 270, 408)


def test_paper_on_two_sides_or_of_two_tones_is_none() -> None:
    assert frame.paper(_printed((9, 12, 0, 0))) == (0, 0, 0, 0)
    patched = _printed((12, 14, 12, 16), tone=240)
    patched[:14] -= 60
    assert frame.paper(patched) == (0, 0, 0, 0)


def test_snow_below_a_white_sky_is_no_paper() -> None:
    winter = _street()
    winter[:120], winter[330:] = 245, 240
    assert frame.exposed(winter) == Box(0, 0, 280, 420)


def test_film_round_paper_is_cut_off_with_it() -> None:
    filmed = np.pad(_printed((9, 12, 10, 14)), 11, constant_values=5)
    assert frame.exposed(filmed) == Box(20, 23, 281, 417)


@needs_data
def test_no_tax_photograph_lies_on_paper() -> None:
    for path in sorted((DATA / "taxphotos" / "photos").glob("*.jpg")):
        image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
        assert frame.exposed(image) == frame.filmed(image), path


@needs_data
@pytest.mark.parametrize("name", PRINTS)
def test_real_prints_are_cut_out_of_their_paper(name: str) -> None:
    path = DATA / "historic_streets" / "photos" / f"{name}.jpg"
    image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    np.testing.assert_allclose(frame.exposed(image), PRINTS[name], atol=2)


@pytest.mark.parametrize("seed", range(4))
def test_the_painted_film_border_is_found(seed: int) -> None:
    rng = np.random.default_rng(seed)
    box, inside = film.exposed(rng, (420, 280))
    light = _street(seed=seed).astype(np.float32)
    found = frame.exposed(film.develop(rng, light, inside))
    np.testing.assert_allclose(found, box, atol=1)
