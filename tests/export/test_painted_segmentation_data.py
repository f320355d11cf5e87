from pathlib import Path

import numpy as np
import pytest

from export.inpainting_data import Sheet
from export.painted_segmentation_data import clean, paint, read_painted, rings, sample
from export.segmentation_data import fill, truth
from nostalgin_core.segment import CATEGORIES


def pierced() -> np.ndarray:
    """Make a mask with a hole in it, in two pieces."""
    mask = np.zeros((60, 50), bool)
    mask[5:40, 5:30] = True
    mask[12:20, 10:22] = False
    mask[45:55, 33:48] = True
    return mask


def test_rings_give_their_mask_back_with_holes_and_pieces() -> None:
    np.testing.assert_array_equal(fill(rings(pierced()), (60, 50)), pierced())


@pytest.mark.parametrize("number", [7])
def test_a_painted_photo_repeats_and_its_outlines_are_its_truth(number: int) -> None:
    image, layers = paint(number, [])
    again, _ = paint(number, [])
    np.testing.assert_array_equal(image, again)
    drawn = sample("painted", image, layers)
    assert {t.category for t in drawn.things} > {"facade", "placard"}
    for thing, layer in zip(drawn.things, layers, strict=True):
        off = fill(thing.rings, image.shape) != (layer > 0)
        assert off.sum() <= 0.02 * (layer > 0).sum() + 4
        assert CATEGORIES[layer.max() - 1] == thing.category
    assert truth(drawn).masks.sum(0).max() == 1


def test_what_was_painted_is_read_back(tmp_path: Path) -> None:
    image, layers = paint(3, [])
    for number in (3, 1):
        path = tmp_path / f"painted{number:05d}.npz"
        np.savez_compressed(path, image=image, layers=layers)
    one, other = read_painted(tmp_path)
    assert (one.name, other.name) == ("painted00001", "painted00003")
    np.testing.assert_array_equal(one.image, image)


def test_a_front_that_others_wear_keeps_what_is_known_of_it() -> None:
    image = np.random.default_rng(0).integers(0, 256, (40, 30), np.uint8)
    known = np.ones(image.shape, bool)
    known[30:, 10:15] = False
    worn = clean(Sheet("one", image, known, held_out=False, kind="front"))
    np.testing.assert_array_equal(worn[known], image[known])
    assert (worn[~known] != image[~known]).any()
