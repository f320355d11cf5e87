from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from export.cells import cells
from export.rare import KINDS, rare
from export.rare_kinds import grazing, hazy, marquee, railway, walled
from export.segmentation_data import Sample, Thing, fill, truth
from tests.export.painted_segmentation import painted, rectangle

SEEDS = range(12)
SHAPE = (128, 128)
SKY, FRONT = 240, 100
Kind = Callable[[Sample, np.random.Generator], Sample]


def street(*, roof: float = 60) -> Sample:
    """A low front between two of its height, before a sky without a cloud."""
    image = np.full(SHAPE, SKY, np.uint8)
    image[int(roof) :] = FRONT
    things = tuple(
        Thing("facade", rectangle(x0, roof, x1, 118), 0)
        for x0, x1 in ((4, 40), (41, 84), (85, 124))
    )
    return Sample("street", image, things)


def changed(kind: Kind, seed: int, sample: Sample) -> Sample:
    return kind(sample, np.random.default_rng(seed))


@pytest.mark.parametrize("seed", SEEDS)
def test_a_wall_rises_from_the_roofs_and_is_no_front(seed: int) -> None:
    sample = street()
    after = changed(walled, seed, sample)
    before, now = truth(sample), truth(after)
    np.testing.assert_array_equal(now.masks, before.masks)
    np.testing.assert_array_equal(now.boxes, before.boxes)
    wall = np.abs(after.image.astype(int) - sample.image) > 30
    assert wall.any()
    assert not (wall & now.masks.any(0)).any()
    columns = np.flatnonzero(wall.any(0))[1:-1]  # less its soft sides
    assert wall[58, columns].all()  # none hangs in the air
    assert cells(after)[1, : 56 // 4].max() == 0  # no share of front above the roofs


def test_there_is_no_wall_where_no_front_is_low() -> None:
    high = street(roof=5)
    assert changed(walled, 0, high) is high


def test_a_wall_stays_behind_what_stands_before_the_sky() -> None:
    lamp = Thing("other", rectangle(60, 4, 66, 118), 1)
    sample = street()
    image = sample.image.copy()
    inside = fill(lamp.rings, SHAPE)
    image[inside] = 20
    after = [
        changed(walled, seed, Sample("lamp", image, (*sample.things, lamp)))
        for seed in SEEDS
    ]
    core = inside.copy()
    core[:, :62], core[:, 65:] = False, False
    for one in after:
        assert (one.image[core] == 20).all()


@pytest.mark.parametrize("kind", [marquee, railway])
@pytest.mark.parametrize("seed", SEEDS)
def test_what_hangs_before_a_front_is_other_and_hides_it(kind: Kind, seed: int) -> None:
    sample = painted(seed)
    after = changed(kind, seed, sample)
    new = after.things[len(sample.things) :]
    assert after.things[: len(sample.things)] == sample.things
    assert new
    hung = np.any([fill(t.rings, SHAPE) for t in new], axis=0)
    assert {t.category for t in new} == {"other"}
    assert min(t.layer for t in new) > max(t.layer for t in sample.things)
    answer = truth(after)
    fronts = answer.masks[answer.labels == 1].any(0)
    assert not (fronts & hung).any()
    assert (truth(sample).masks[truth(sample).labels == 1].any(0) & hung).any()
    moved = np.abs(after.image.astype(int) - sample.image) > 30
    near = np.zeros(SHAPE, bool)
    ys, xs = np.nonzero(hung)
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            near[np.clip(ys + dy, 0, 127), np.clip(xs + dx, 0, 127)] = True
    assert not (moved & ~near).any()


def test_a_marquee_hangs_in_the_lower_half_of_one_front() -> None:
    for seed in SEEDS:
        slab = changed(marquee, seed, street()).things[-1].rings[0]
        assert slab[:, 1].min() > 60 + 0.4 * 58
        middle = slab[:, 0].mean()
        assert any(x0 < middle < x1 for x0, x1 in ((4, 40), (41, 84), (85, 124)))


def test_a_railway_crosses_the_whole_street() -> None:
    for seed in SEEDS:
        girder, *posts = changed(railway, seed, street()).things[3:]
        assert fill(girder.rings, SHAPE).any(0).all()
        assert 1 <= len(posts) <= 3
        for post in posts:  # and stands: a post begins under its girder without a slit
            both = fill(girder.rings, SHAPE) | fill(post.rings, SHAPE)
            middle = int(np.clip(round(post.rings[0][:, 0].mean()), 0, 127))
            column = np.flatnonzero(both[:, middle])
            assert (np.diff(column) == 1).all()


def test_haze_moves_no_outline_and_brightens_what_stands_high() -> None:
    for seed in SEEDS:
        sample = street(roof=10)
        after = changed(hazy, seed, sample)
        assert after.things == sample.things
        veil = after.image.astype(int) - sample.image
        assert veil[12].min() > 10
        assert (veil[100:] == 0).all()
        assert (np.diff(veil[12:].mean(1)) <= 0).all()


@pytest.mark.parametrize("seed", SEEDS)
def test_a_row_seen_along_its_side_keeps_its_labels(seed: int) -> None:
    sample = painted(seed)
    image = np.full(SHAPE, 200, np.uint8)
    front = sample.things[0]
    image[fill(front.rings, SHAPE)] = 60
    after = changed(grazing, seed, Sample("one", image, (front,)))
    assert after.image.shape == SHAPE
    drawn = after.image < 130
    outline = truth(after).masks.any(0)
    assert (drawn ^ outline).sum() <= 0.03 * outline.sum() + 2 * 81  # an edge's pixel
    widths = np.ptp(front.rings[0][:, 0])
    assert np.ptp(after.things[0].rings[0][:, 0]) < 0.76 * widths


def test_what_a_view_cut_off_does_not_cross_into_the_mirror() -> None:
    wide = Thing("facade", rectangle(90, 20, 400, 100), 0, target=True)
    image = np.full(SHAPE, 200, np.uint8)
    image[fill(wide.rings, SHAPE)] = 60
    for seed in SEEDS:
        after = changed(grazing, seed, Sample("wide", image, (wide,)))
        answer = truth(after)
        assert not (answer.masks.sum(0) > 1).any()
        assert ((after.image < 130) ^ answer.masks.any(0)).sum() <= 4 * 81
        assert sum(t.target for t in after.things) == 1


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
def test_a_seed_gives_the_same_bytes_and_leaves_what_it_was_given(kind: Kind) -> None:
    sample = painted(3)
    kept = sample.image.copy()
    one, two = (changed(kind, 4, sample) for _ in range(2))
    assert one.image.dtype == np.uint8
    assert one.image.tobytes() == two.image.tobytes()
    np.testing.assert_array_equal(truth(one).masks, truth(two).masks)
    np.testing.assert_array_equal(sample.image, kept)


@pytest.mark.parametrize("border", [(4, "film"), (251, "margin")])
def test_a_border_stays_as_it_is(border: tuple[int, str]) -> None:
    tone, name = border
    sample = street()
    image = np.full((144, 144), tone, np.uint8)
    image[8:136, 8:136] = np.where(sample.image == SKY, 150, sample.image)
    things = tuple(
        replace(t, rings=tuple(ring + 8 for ring in t.rings)) for t in sample.things
    )
    inside = np.zeros(image.shape, bool)
    inside[8:136, 8:136] = True
    spoilt = 0
    for seed in SEEDS:
        after = changed(rare, seed, Sample(name, image, things))
        assert (after.image[~inside] == tone).all()
        assert not (truth(after).masks.any(0) & ~inside).any()
        spoilt += after.things != things or bool((after.image != image).any())
    assert spoilt == len(SEEDS)


def test_a_photo_without_labels_is_left_without() -> None:
    plain = Sample("plain", np.full(SHAPE, 128, np.uint8), ())
    for seed in SEEDS:
        after = changed(rare, seed, plain)
        assert {t.category for t in after.things} <= {"other"}
