"""A painted watermark comes off painted streets; photos without it stay as they are."""

from functools import cache

import cv2
import numpy as np
import pytest

from nostalgin_core import scenes
from nostalgin_core.arrays import Gray
from nostalgin_core.measure import watermarks
from nostalgin_core.records import Box, Photo
from nostalgin_core.rectify import Watermark, unmarked
from nostalgin_core.rectify.watermark import fit, laid

CELLS = (96, 144)
STEP = (0.2811, 0.1907)  # no whole pixels: every place of the tile is seen


def painted() -> Watermark:
    """A mark with letters in light gray and a darker rim, as archives' are."""
    drawn = np.zeros(CELLS, np.uint8)
    place = (12, 40)
    cv2.putText(drawn, "ARCHIVE", place, cv2.FONT_HERSHEY_SIMPLEX, 0.8, 255, 2)
    text = drawn.astype(np.float32) / 255
    letters = cv2.GaussianBlur(text, (0, 0), 0.8)
    rim = np.clip(cv2.GaussianBlur(text, (0, 0), 1.8) - letters, 0, 1)
    covers = letters * np.float32(0.25)
    return Watermark("ARCHIVE", covers, letters * 32 - rim * 6, STEP)


MARK = painted()


@cache
def streets() -> tuple[Gray, ...]:
    hood = scenes.neighbourhood(np.random.default_rng(3))
    lots = [lot for block in hood.blocks for lot in block.lots if not lot.ruined]
    return tuple(
        scenes.photograph(hood, lot, np.random.default_rng(n), shape=(600, 400)).image
        for n, lot in enumerate(lots[:6])
    )


def marked(image: Gray, mark: Watermark = MARK) -> Gray:
    covers, adds = laid(mark, image.shape)
    return np.clip(np.rint(image * (1 - covers) + adds), 0, 255).astype(np.uint8)


def photo(image: Gray) -> Photo:
    return Photo("k", image, Box(0, 0, image.shape[1], image.shape[0]))


@pytest.mark.parametrize("number", range(6))
def test_taking_a_mark_out_gives_back_the_photograph(number: int) -> None:
    street = streets()[number]
    clear, words = unmarked(photo(marked(street)), MARK)
    assert words == "ARCHIVE"
    kept = (street > 12) & (street < 243)  # what the copy did not clip
    assert np.abs(clear.image.astype(int) - street)[kept].max() <= 1


@pytest.mark.parametrize("number", range(6))
def test_a_photo_without_the_mark_stays_itself(number: int) -> None:
    bare = photo(streets()[number])
    clear, words = unmarked(bare, MARK)
    assert clear is bare
    assert words == ""


def test_without_a_known_mark_a_marked_photo_stays_itself() -> None:
    bare = photo(marked(streets()[0]))
    assert unmarked(bare, None) == (bare, "")


def test_a_mark_that_is_laid_elsewhere_is_not_taken_for_it() -> None:
    shifted = np.roll(MARK.covers, 40, 0), np.roll(MARK.adds, 40, 0)
    other = Watermark("ARCHIVE", *shifted, STEP)
    assert not fit(marked(streets()[1], other), MARK).borne


def test_a_mark_as_wide_as_the_photo_is_found_at_any_size() -> None:
    for size in ((300, 450), (900, 1350), (1400, 2100)):
        street = cv2.resize(streets()[2], size, interpolation=cv2.INTER_CUBIC)
        assert fit(marked(street), MARK).borne


def test_taking_a_mark_out_twice_is_taking_it_out_once() -> None:
    once, _ = unmarked(photo(marked(streets()[3])), MARK)
    again, words = unmarked(once, MARK)
    assert again is once
    assert words == ""


@pytest.mark.parametrize("tone", [0, 3, 252, 255])
def test_no_tone_wraps_round(tone: int) -> None:
    image = streets()[4].copy()
    image[100:500, 50:350] = tone
    clear, words = unmarked(photo(marked(image)), MARK)
    assert words
    shown = clear.image[120:480, 70:330].astype(int)
    assert np.abs(shown - tone).max() < 60


def test_a_photo_too_narrow_to_read_the_mark_in_is_not_looked_at() -> None:
    assert fit(np.zeros((100, 100), np.uint8), MARK).strength == 0.0


def skies(count: int) -> list[Gray]:
    """Ramps with grain: even grounds, of tones from dark to bright."""
    rng = np.random.default_rng(8)
    across = np.linspace(-1, 1, 400)
    rows = [rng.uniform(60, 200) + rng.uniform(-50, 50) * across for _ in range(count)]
    grain = [rng.normal(0, 1.5, (600, 400)) for _ in rows]
    return [
        np.clip(row + own, 0, 255).astype(np.uint8)
        for row, own in zip(rows, grain, strict=True)
    ]


def test_a_tile_is_measured_again_from_the_copies_that_bear_it() -> None:
    copies = [marked(one) for one in skies(12)]
    found = watermarks.measured(lambda: copies, MARK)
    lettered = MARK.covers > 0.1
    assert np.abs(found.covers - MARK.covers)[lettered].mean() < 0.04
    assert np.abs(found.adds - MARK.adds)[lettered].mean() < 5.0
    street = marked(streets()[5])
    clear, words = unmarked(photo(street), found)
    assert words
    before, after = (abs(fit(one, MARK).strength) for one in (street, clear.image))
    assert after < 0.2 * before
