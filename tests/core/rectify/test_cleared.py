"""On a finer copy the tiles' steps and place are sought, and the mark comes off."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from nostalgin_core.records import Box, Photo
from nostalgin_core.rectify import unmarked
from nostalgin_core.rectify.watermark import Watermark, fit
from tests.core.rectify.test_watermark import MARK, STEP, marked, streets

FINE = (800, 1200)


@pytest.mark.parametrize("seat", [(1.0, 1.0, 0.0), (0.998, 1.002, 0.006)])
def test_a_finer_copy_is_solved_where_its_tiles_lie(
    seat: tuple[float, float, float],
) -> None:
    street = cv2.resize(streets()[2], FINE, interpolation=cv2.INTER_CUBIC)
    step = STEP[0] * seat[0], STEP[1] * seat[1]
    laid = replace(MARK, step=step, shift=(seat[2], -seat[2]))
    copy = marked(street, laid)
    frame = Box(0, 0, FINE[0], FINE[1])
    clear, words = unmarked(Photo("k", copy, frame), MARK)
    assert words == MARK.words
    off, was = (np.abs(one.astype(int) - street) for one in (clear.image, copy))
    assert off.mean() < 0.3 * was.mean()


def test_a_finer_copy_whose_tiles_are_of_another_size_keeps_its_mark() -> None:
    street = cv2.resize(streets()[2], FINE, interpolation=cv2.INTER_CUBIC)
    other: Watermark = replace(MARK, step=(STEP[0] * 1.06, STEP[1] * 0.95))
    copy = Photo("k", marked(street, other), Box(0, 0, FINE[0], FINE[1]))
    assert unmarked(copy, MARK) == (copy, "")
    assert abs(fit(copy.image, MARK).strength) < 0.5
