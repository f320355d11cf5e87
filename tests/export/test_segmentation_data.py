import numpy as np
import pytest

from export.copy_paste import donors, paste
from export.segmentation_data import UNSCORED, read_folder, some, truth, view
from export.wear import wear
from nostalgin_core.segment import CATEGORIES
from tests.data import DATA, needs_data
from tests.export.painted_segmentation import painted

FACADE = CATEGORIES.index("facade") + 1
VEHICLE = CATEGORIES.index("vehicle") + 1


def test_a_front_is_visible_where_nothing_stands_before_it() -> None:
    answer = truth(painted())
    left, right, far, car = answer.masks
    assert answer.labels.tolist() == [FACADE, FACADE, UNSCORED, VEHICLE]
    assert not ((left | right | far) & car).any()
    assert left[50, 20]
    assert car[90, 40]
    assert not left[90, 40]


def test_boxes_hold_their_masks_exactly() -> None:
    answer = truth(painted())
    for box, mask in zip(answer.boxes.astype(int), answer.masks, strict=True):
        x0, y0, x1, y1 = box
        assert mask[y0:y1, x0:x1].sum() == mask.sum()
        assert mask[y0].any()
        assert mask[y1 - 1].any()
        assert mask[:, x0].any()
        assert mask[:, x1 - 1].any()


@pytest.mark.parametrize("seed", range(8))
def test_outlines_follow_the_picture_through_every_view(seed: int) -> None:
    sample = view(painted(), np.random.default_rng(seed), short_px=(150, 260))
    assert all(side % 32 == 0 for side in sample.image.shape)
    answer = truth(sample)
    cars = answer.masks[answer.labels == VEHICLE]
    for car in cars:  # painted darkest, so the picture itself says where it is
        assert np.median(sample.image[car]) < 60
        assert (sample.image[car] < 100).mean() > 0.9


def test_views_repeat_with_their_seed() -> None:
    one, other = (view(painted(), np.random.default_rng(5)) for _ in range(2))
    np.testing.assert_array_equal(one.image, other.image)


def test_what_is_pasted_is_drawn_and_outlined_in_one_place() -> None:
    clean = painted()
    cut = donors([clean])
    assert [d.category for d in cut] == ["vehicle"]
    sample = paste(clean, cut * 3, np.random.default_rng(4), most=3)
    new = sample.things[len(clean.things) :]
    assert new
    answer = truth(sample)
    changed = sample.image != clean.image
    assert not (changed & ~np.any(answer.masks[-len(new) :], axis=0)).any()


def test_what_is_pasted_later_stands_before_what_was_there() -> None:
    clean = painted()
    sample = paste(clean, donors([clean]) * 4, np.random.default_rng(4), most=4)
    assert len(sample.things) > len(clean.things) + 1
    masks = truth(sample).masks
    assert masks.sum(0).max() == 1


def test_wear_keeps_the_size_and_repeats() -> None:
    image = painted().image
    for seed in range(20):
        one, other = (wear(image, np.random.default_rng(seed)) for _ in range(2))
        assert one.shape == image.shape
        np.testing.assert_array_equal(one, other)
    assert not np.array_equal(image, painted(1).image)


@needs_data
def test_the_held_out_block_is_never_trained_on() -> None:
    folder = DATA / "taxphotos"
    learnt = {s.name for s in read_folder(folder)}
    held = {s.name for s in read_folder(folder, held_out=True)}
    assert all(name.startswith("00993") for name in held)
    assert not any(name.startswith("00993") for name in learnt)
    assert len(held) == 20
    assert len(learnt) + len(held) == 99


@needs_data
def test_a_smaller_share_of_the_labels_is_part_of_a_larger_one() -> None:
    samples = read_folder(DATA / "taxphotos")
    names = [{s.name for s in some(samples, share)} for share in (0.25, 0.5, 1.0)]
    assert names[0] < names[1] < names[2] == {s.name for s in samples}
    assert 0.35 < len(names[1]) / len(names[2]) < 0.65
    with pytest.raises(ValueError, match="at most 1"):
        some(samples, 1.5)
