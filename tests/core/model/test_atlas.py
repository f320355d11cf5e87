import numpy as np
import pytest

from nostalgin_core import evidence
from nostalgin_core.model import atlas
from nostalgin_core.records import Box, Elevation
from tests.core import sample_block as sample


def elevation(h: int, w: int, *, seed: int = 0) -> Elevation:
    return sample.plain(np.random.default_rng(seed).integers(0, 256, (h, w), np.uint8))


def boxes_overlap(a: Box, b: Box, margin: int) -> bool:
    return (
        a.x0 - margin < b.x1 + margin
        and b.x0 - margin < a.x1 + margin
        and a.y0 - margin < b.y1 + margin
        and b.y0 - margin < a.y1 + margin
    )


def test_a_tile_that_fits_the_budget_is_copied_texel_for_texel() -> None:
    one = elevation(120, 90)
    made = atlas.build({("a", 0, None): one})
    box = made.tiles["a", 0, None]
    np.testing.assert_array_equal(
        made.image[box.y0 : box.y1, box.x0 : box.x1], one.image
    )


def test_tiles_and_their_gutters_never_overlap() -> None:
    rng = np.random.default_rng(3)
    views = {
        (f"{k}", 0, None): elevation(*rng.integers(10, 300, 2), seed=k)
        for k in range(25)
    }
    made = atlas.build(views)
    boxes = [*made.tiles.values(), *made.patches]
    for index, a in enumerate(boxes):
        assert not any(boxes_overlap(a, b, atlas.GUTTER_PX) for b in boxes[index + 1 :])
        assert a.x0 - atlas.GUTTER_PX >= 0
        assert a.x1 + atlas.GUTTER_PX <= made.image.shape[1]
        assert a.y1 + atlas.GUTTER_PX <= made.image.shape[0]


def test_a_gutter_repeats_the_border_of_its_tile() -> None:
    one = elevation(50, 40)
    made = atlas.build({("a", 0, None): one})
    box = made.tiles["a", 0, None]
    left = made.image[box.y0 : box.y1, box.x0 - atlas.GUTTER_PX : box.x0]
    np.testing.assert_array_equal(left, np.repeat(one.image[:, :1], atlas.GUTTER_PX, 1))


@pytest.mark.parametrize("limit_px", [256, 512])
def test_too_many_tiles_shrink_until_they_fit(limit_px: int) -> None:
    views = {(f"{k}", 0, None): elevation(200, 150, seed=k) for k in range(12)}
    made = atlas.build(views, limit_px=limit_px)
    assert max(made.image.shape) <= limit_px
    sizes = {(b.y1 - b.y0, b.x1 - b.x0) for b in made.tiles.values()}
    assert len(sizes) == 1
    h, w = sizes.pop()
    assert h / w == pytest.approx(4 / 3, rel=0.1)


def test_transparent_texels_take_their_neighbours_colour() -> None:
    image = np.full((40, 40), 200, np.uint8)
    image[:10] = 0
    codes = np.full((40, 40), evidence.PHOTOGRAPHED, np.uint8)
    codes[:10] = evidence.NOTHING
    made = atlas.build({("a", 0, None): sample.plain(image, codes)})
    box = made.tiles["a", 0, None]
    tile = (slice(box.y0, box.y1), slice(box.x0, box.x1))
    assert (made.image[tile] == 200).all()
    assert (made.opacity[tile][:10] == 0).all()
    assert (made.opacity[tile][10:] == 255).all()
    assert (made.evidence[tile][:10] == evidence.NOTHING).all()


def test_what_was_hidden_and_filled_is_opaque() -> None:
    codes = np.full((30, 30), evidence.INPAINTED, np.uint8)
    one = sample.plain(np.full((30, 30), 90, np.uint8), codes)
    assert atlas.opaque(one).all()


def test_a_soft_edge_at_the_sky_is_cut_in_the_middle_one_at_a_car_is_not() -> None:
    codes = np.full((30, 30), evidence.PHOTOGRAPHED, np.uint8)
    codes[:5], codes[5:8] = evidence.NOTHING, evidence.SOFT_EDGE
    codes[20:23] = evidence.SOFT_EDGE
    codes[23:] = evidence.INPAINTED
    alpha = (codes == evidence.PHOTOGRAPHED).astype(np.float32)
    alpha[5:8] = np.array([0.2, 0.4, 0.7], np.float32)[:, None]
    alpha[20:23] = 0.3
    kept = atlas.opaque(sample.plain(np.zeros((30, 30), np.uint8), codes, alpha))
    np.testing.assert_array_equal(kept[:, 0], np.arange(30) >= 7)


def test_scaled_evidence_never_calls_a_mixed_texel_photographed() -> None:
    codes = np.full((64, 64), evidence.PHOTOGRAPHED, np.uint8)
    codes[:, 31:] = evidence.INPAINTED
    small = atlas.scaled_codes(codes, (16, 16))
    pure = (codes == evidence.PHOTOGRAPHED).reshape(16, 4, 16, 4).all((1, 3))
    assert not ((small == evidence.PHOTOGRAPHED) & ~pure).any()
    assert (small[pure] == evidence.PHOTOGRAPHED).all()


def test_a_copy_has_a_tile_of_its_own_marked_as_such() -> None:
    one = elevation(100, 80)
    made = atlas.build({("a", 0, None): one, ("a", 0, evidence.COPIED): one})
    box = made.tiles["a", 0, evidence.COPIED]
    assert (made.evidence[box.y0 : box.y1, box.x0 : box.x1] == evidence.COPIED).all()


def test_the_order_of_tiles_in_the_input_changes_nothing() -> None:
    views = {(f"{k}", 0, None): elevation(30 + k, 40, seed=k) for k in range(6)}
    backwards = dict(reversed(list(views.items())))
    a, b = atlas.build(views), atlas.build(backwards)
    np.testing.assert_array_equal(a.image, b.image)
    assert a.tiles == b.tiles


def test_a_tile_too_wide_for_a_shelf_is_refused() -> None:
    with pytest.raises(ValueError, match="does not fit"):
        atlas.shelves([(10, 300)], width=256)


def test_tiles_that_fit_no_atlas_are_refused_and_not_shrunk_for_ever() -> None:
    with pytest.raises(ValueError, match="100 tiles fit no atlas of 128 px"):
        atlas.layout([(50, 50)] * 100, longest_px=50, limit_px=128)
    boxes, (height, width) = atlas.layout([(50, 50)] * 100, longest_px=50, limit_px=256)
    assert max(height, width) <= 256
    assert len(boxes) == 100
