"""The network sees a print on its paper; what it answers is of the picture alone."""

import numpy as np
import pytest

from nostalgin_core.photo import framed
from nostalgin_core.records import Box, Instance, Photo
from nostalgin_core.segment import segment
from nostalgin_core.segment.segment import everything
from nostalgin_core.segment.sheet import of_frame, within
from tests.outdoors import outdoors

SHEET, FRAME = Box(0, 0, 240, 160), Box(24, 16, 220, 120)


def _print() -> np.ndarray:
    rng = np.random.default_rng(0)
    image = np.full((416, 608), 235, np.uint8)
    image[32:352, 40:568] = rng.integers(20, 160, (320, 528))
    return image


def _answering(gray: np.ndarray) -> tuple[np.ndarray, ...]:
    """Find one front, all over what is shown, and tell pixels by where they lie."""
    height, width = gray.shape[-2:]
    pixels = np.zeros((4, height // 4, width // 4), np.float32)
    pixels[1] = np.linspace(0.2, 0.99, width // 4)
    box = np.array([[0, 0, width, height]], np.float32)
    one = np.ones(1, np.float32)
    return (
        box,
        np.ones(1, int),
        one,
        np.ones((1, 46, 46), np.float32),
        pixels,
        outdoors(gray),
    )


def test_what_is_cut_down_to_a_frame_stays_where_it_is() -> None:
    xs, ys = np.meshgrid(np.arange(60) + 0.5, np.arange(40) + 0.5)
    pixels = np.stack([xs, ys, xs + ys, xs - ys]).astype(np.float32) / 100
    cut = of_frame(pixels, SHEET, FRAME)
    height, width = cut.shape[1:]
    assert (height, width) == (26, 49)
    x_px = FRAME.x0 + (np.arange(width) + 0.5) * (FRAME.x1 - FRAME.x0) / width
    np.testing.assert_allclose(cut[0], np.tile(x_px / 400, (height, 1)), atol=1e-3)
    y_px = FRAME.y0 + (np.arange(height) + 0.5) * (FRAME.y1 - FRAME.y0) / height
    np.testing.assert_allclose(cut[1].T, np.tile(y_px / 400, (width, 1)), atol=1e-3)


def test_a_frame_that_is_the_sheet_changes_no_bit() -> None:
    pixels = np.random.default_rng(1).random((4, 40, 60), np.float32)
    np.testing.assert_array_equal(of_frame(pixels, SHEET, SHEET), pixels)


def test_things_keep_what_lies_in_the_frame() -> None:
    likely = np.random.default_rng(2).random((50, 60), np.float32)
    across = Instance("facade", 0.9, Box(10, 0, 70, 50), likely)
    beside = Instance("other", 0.9, Box(0, 0, 20, 50), likely[:, :20])
    (one,) = within([across, beside], FRAME)
    assert one.box == Box(24, 16, 70, 50)
    np.testing.assert_array_equal(one.probability, likely[16:, 14:])


def test_a_print_is_shown_with_its_paper_and_nothing_found_on_that() -> None:
    photo = framed("a print", _print())
    assert photo.sheet == Box(0, 0, 608, 416)
    shown: list[np.ndarray] = []

    def network(gray: np.ndarray) -> tuple[np.ndarray, ...]:
        shown.append(gray)
        return _answering(gray)

    found = everything(photo, network, least=0.2)
    assert shown[0].shape[-2:] == (416, 608)
    assert [one.box for one in found.things] == [photo.frame]
    rows, columns = found.pixels.shape[1:]
    assert (rows, columns) == (80, 132)
    assert 0.2 < found.pixels[1].min() < found.pixels[1].max() < 0.99
    assert found.sure == pytest.approx((np.linspace(0.2, 0.99, 152) > 0.9).mean())
    kept = segment(photo, _answering)
    assert all(
        photo.frame.x0 <= one.box.x0 and one.box.x1 <= photo.frame.x1 for one in kept
    )


def test_a_photo_without_paper_is_shown_its_frame() -> None:
    image = _print()[32:352, 40:568]
    photo = framed("a photo", image)
    assert photo.sheet is None
    found = everything(photo, _answering, least=0.2)
    bare = everything(Photo("a photo", image, photo.frame), _answering, least=0.2)
    np.testing.assert_array_equal(found.pixels, bare.pixels)
