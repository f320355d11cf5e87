import cv2
import numpy as np
import pytest

from export.blemishes import blemished, lettered
from export.segmentation_data import Sample, fill, tilted
from tests.export.painted_segmentation import painted

SEEDS = range(60)


def plain() -> Sample:
    return Sample("plain", np.full((300, 240), 128, np.uint8), ())


def spoilt() -> list[Sample]:
    """Blemish a plain gray photo often enough to see every kind."""
    return [blemished(plain(), np.random.default_rng(seed)) for seed in SEEDS]


def test_what_a_blemish_hides_is_to_be_found_as_other_and_is_lost() -> None:
    hidden = [(s, t) for s in spoilt() for t in s.things]
    assert len(hidden) >= 5
    for sample, thing in hidden:
        assert thing.category == "other"
        assert thing.layer > 0
        inside = fill(thing.rings, sample.image.shape)
        inside = cv2.erode(inside.astype(np.uint8), np.ones((5, 5))) > 0
        tones = sample.image[inside]
        assert ((tones < 80) | (tones > 190)).mean() > 0.9


def test_letters_hide_nothing() -> None:
    gray = plain().image
    changes = []
    for seed in SEEDS:
        written = lettered(gray, np.random.default_rng(seed))
        changes.append((written != gray).mean())
        assert np.abs(written.astype(int) - gray).max() <= 45
    assert np.mean([change > 0.005 for change in changes]) > 0.8


def test_a_blemish_repeats_and_leaves_the_photo_it_was_given() -> None:
    before = plain()
    one, other = (blemished(before, np.random.default_rng(4)) for _ in range(2))
    np.testing.assert_array_equal(one.image, other.image)
    assert (before.image == 128).all()
    assert before.things == ()


@pytest.mark.parametrize("seed", range(3))
def test_outlines_turn_with_the_photo(seed: int) -> None:
    sample = painted()
    shape = sample.image.shape
    for thing in sample.things:
        mask = fill(thing.rings, shape)
        alone = Sample("mask", mask.astype(np.uint8) * 255, (thing,))
        turned = tilted(alone, np.random.default_rng(seed))
        outline = fill(turned.things[0].rings, shape)
        drawn = turned.image > 127
        border = shape[0] * 2 + shape[1] * 2  # replicated beyond the frame
        rim = cv2.dilate(outline.astype(np.uint8), np.ones((3, 3))) > 0
        assert (drawn & ~rim).sum() < border
        assert (outline & ~drawn).sum() <= 0.1 * outline.sum() + 8
