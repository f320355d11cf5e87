"""An overlay that photographs share is learnt; where none is, none is told."""

from functools import cache

import cv2
import numpy as np
import pytest

from nostalgin_core.arrays import Gray
from nostalgin_core.measure import overlays
from nostalgin_core.records import Box, Photo
from nostalgin_core.rectify import Watermark, unmarked
from nostalgin_core.rectify.watermark import fit, laid

WIDE, TALL = 400, 520
STEP = (0.3107, 0.1803)


@cache
def streets() -> tuple[Gray, ...]:
    """Even walls of many tones, with windows and grain, no two alike."""
    rng = np.random.default_rng(4)
    made = []
    for _ in range(24):
        image = np.full((TALL, WIDE), rng.uniform(60, 200), np.float32)
        image += rng.uniform(-30, 30) * np.linspace(-1, 1, WIDE)
        for _ in range(40):
            x, y = rng.integers(0, (WIDE, TALL))
            image[y : y + 30, x : x + 18] += rng.uniform(-60, 40)
        image += rng.normal(0, 2, image.shape)
        made.append(np.clip(image, 0, 255).astype(np.uint8))
    return tuple(made)


def painted(covers: float, adds: float, from_top: float = 0.5) -> Watermark:
    """A mark of another shape and step than New York's."""
    drawn = np.zeros((144, 248), np.uint8)
    cv2.putText(drawn, "ARLES", (40, 90), cv2.FONT_HERSHEY_SIMPLEX, 1.4, 255, 4)
    letters = cv2.GaussianBlur(drawn.astype(np.float32) / 255, (0, 0), 0.8)
    covers_, adds_ = letters * np.float32(covers), letters * np.float32(adds)
    return Watermark("ARLES", covers_, adds_, STEP, from_top)


def marked(image: Gray, mark: Watermark) -> Gray:
    covers, adds = laid(mark, image.shape)
    return np.clip(np.rint(image * (1 - covers) + adds), 0, 255).astype(np.uint8)


@pytest.mark.parametrize(
    ("covers", "adds", "from_top"), [(0.3, 70.0, 0.5), (0.3, 0.0, 0.0)]
)
def test_a_painted_overlay_is_learnt_and_comes_off(
    covers: float, adds: float, from_top: float
) -> None:
    truth = painted(covers, adds, from_top)
    shapes = TALL, TALL - 40, TALL - 90
    copies = [marked(one[: shapes[n % 3]], truth) for n, one in enumerate(streets())]
    found = overlays.learnt(copies, "ARLES")
    assert found, found.why
    assert found.mark is not None
    assert np.allclose(found.mark.step, STEP, rtol=0.002)
    size = truth.covers.shape[::-1]
    shown = cv2.resize(overlays.visible(found.mark), size)
    both = np.corrcoef(shown.ravel(), overlays.visible(truth).ravel())[0, 1]
    assert both > 0.9
    copy = Photo("k", copies[0], Box(0, 0, WIDE, TALL))
    clear, words = unmarked(copy, found.mark)
    assert words == "ARLES"
    assert abs(fit(clear.image, truth).strength) < 0.25


def test_photographs_without_an_overlay_share_none() -> None:
    found = overlays.learnt(streets(), "ARLES")
    assert not found
    assert "share" in found.why or "same" in found.why


def test_few_photographs_tell_nothing() -> None:
    found = overlays.learnt(streets()[:5], "ARLES")
    assert not found
    assert "20" in found.why
