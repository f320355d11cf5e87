from dataclasses import replace

import numpy as np
import pytest

from nostalgin_core import evidence
from nostalgin_core.measure.rectification import worst_angle_deg
from nostalgin_core.records import Box, Elevation, Facade, Matted, Photo, Rejection
from nostalgin_core.rectify import orient, upright
from nostalgin_core.rectify.rectify import elevation, lean_sd_deg, rectify
from tests.painted_front import Painted, photograph


@pytest.fixture(scope="module")
def corner() -> Painted:
    return photograph()


@pytest.fixture(scope="module")
def straightened(corner: Painted) -> list[Elevation]:
    results = rectify(corner.photo, corner.matted)
    assert all(results)
    return [r for r in results if isinstance(r, Elevation)]


def test_a_painted_corner_comes_out_with_right_angles(
    corner: Painted, straightened: list[Elevation]
) -> None:
    for quad, result in zip(corner.quads, straightened, strict=True):
        assert worst_angle_deg(quad, result.photo_from_elevation) < 0.5


def test_a_painted_corner_tells_its_aspect_ratios(
    corner: Painted, straightened: list[Elevation]
) -> None:
    for aspect, result in zip(corner.aspects, straightened, strict=True):
        assert result.aspect == pytest.approx(aspect, rel=0.03)


def test_a_painted_corner_tells_its_focal_length(
    corner: Painted, straightened: list[Elevation]
) -> None:
    for result in straightened:
        assert result.focal_px == pytest.approx(corner.focal_px, rel=0.05)


def test_the_quad_is_the_painted_one(
    corner: Painted, straightened: list[Elevation]
) -> None:
    for quad, result in zip(corner.quads, straightened, strict=True):
        np.testing.assert_allclose(result.quad, quad, atol=3.0)


def test_a_clear_view_is_photographed_nearly_everywhere(
    straightened: list[Elevation],
) -> None:
    for result in straightened:
        assert np.mean(result.evidence == evidence.PHOTOGRAPHED) > 0.9


def test_what_an_occluder_hides_waits_for_the_inpainter(corner: Painted) -> None:
    left = corner.matted.facades[0]
    alpha = left.alpha.copy()
    alpha[300:400, 200:260] = 0
    hidden = replace(left, alpha=alpha)
    (result,) = rectify(corner.photo, Matted((hidden,), ()))
    assert isinstance(result, Elevation)
    waiting = result.evidence == evidence.INPAINTED
    assert np.mean(waiting) > 0.02
    assert not result.image[waiting].any()


def test_the_same_photo_gives_the_same_bytes(corner: Painted) -> None:
    first, second = (
        [
            r.image.tobytes()
            for r in rectify(corner.photo, corner.matted)
            if isinstance(r, Elevation)
        ]
        for _ in range(2)
    )
    assert first
    assert first == second


def test_a_blank_wall_is_rejected_with_a_reason(corner: Painted) -> None:
    blank = Photo("0" * 16, np.full_like(corner.photo.image, 128), corner.photo.frame)
    results = rectify(blank, corner.matted)
    assert [r.reason for r in results if not isinstance(r, Elevation)] == [
        "too few lines"
    ] * 2
    assert [r.facade for r in results if not isinstance(r, Elevation)] == [0, 1]


def stripped(corner: Painted, index: int) -> Photo:
    """Wash a front's lines out, but for those of its outline."""
    image = corner.photo.image.copy()
    seen = corner.matted.facades[index].mask
    image[seen] = 150
    return replace(corner.photo, image=image)


def test_a_front_without_lines_borrows_its_neighbours_direction(
    corner: Painted,
) -> None:
    left, right = corner.matted.facades
    hidden_right = replace(right, alpha=np.zeros_like(right.alpha))
    one, other = rectify(
        stripped(corner, 1), replace(corner.matted, facades=(left, hidden_right))
    )
    assert isinstance(one, Elevation)
    assert one.method == "two vanishing points"
    assert isinstance(other, Elevation)
    assert other.method == "a neighbour's direction"
    assert worst_angle_deg(corner.quads[1], other.photo_from_elevation) < 3
    assert other.vanishing_sd_deg[0] > 2 * one.vanishing_sd_deg[0]


def test_a_speck_is_too_small(corner: Painted) -> None:
    left = corner.matted.facades[0]
    speck = np.zeros_like(left.mask)
    speck[200:210, 150:400] = True
    tiny = replace(left, mask=speck, amodal=speck, alpha=speck.astype(np.float32))
    results = rectify(
        corner.photo, replace(corner.matted, facades=(*corner.matted.facades, tiny))
    )
    assert not results[2]


def test_one_level_front_leaves_the_focal_length_untold() -> None:
    level = photograph(azimuths_deg=(0.0,), aspects=(0.8,), tilt_deg=0.0, roll_deg=0.0)
    (result,) = rectify(level.photo, level.matted)
    assert isinstance(result, Elevation)
    assert result.focal_px is None
    assert result.aspect == pytest.approx(0.8, rel=0.03)


def test_a_photo_without_facades_gives_nothing(corner: Painted) -> None:
    assert rectify(corner.photo, Matted((), ())) == ()


@pytest.mark.parametrize("shape", [(1, 1), (2, 30), (24, 24), (90, 60)])
@pytest.mark.parametrize("filled", [False, True], ids=["empty", "filled"])
def test_any_small_noise_is_answered(shape: tuple[int, int], *, filled: bool) -> None:
    rng = np.random.default_rng(shape[0])
    image = rng.integers(0, 255, shape, dtype=np.uint8)
    photo = Photo("0" * 16, image, Box(0, 0, shape[1], shape[0]))
    mask = np.full(shape, filled)
    facade = Facade(0, 1.0, filled, 1.0, mask, mask, mask.astype(np.float32))
    (result,) = rectify(photo, Matted((facade,), ()))
    assert isinstance(result, Elevation | Rejection)


def test_far_corners_are_cut_off_by_a_rejection_and_not_by_memory(
    corner: Painted,
) -> None:
    everything = np.ones_like(corner.matted.facades[0].mask)
    wide = replace(corner.matted.facades[0], mask=everything, amodal=everything)
    (result,) = rectify(corner.photo, replace(corner.matted, facades=(wide,)))
    if isinstance(result, Elevation):
        assert result.image.size < 4 * everything.size


def known_to(corner: Painted, sd_deg: float) -> upright.Upright:
    """Make the painted corner's world, with roll and tilt known to so many degrees."""
    world = orient.orient(corner.photo, corner.matted.facades).world
    sds = np.radians([0.0, sd_deg, sd_deg, 0.0, 0.0])
    return upright.Upright(world.parameters, np.diag(sds**2), world.support)


def test_a_side_leans_in_proportion_to_what_is_unsure(corner: Painted) -> None:
    leans = [
        lean_sd_deg(corner.photo, known_to(corner, sd), 0, corner.quads[0])
        for sd in (0.0, 0.5, 1.0)
    ]
    assert leans[0] == 0
    assert leans[2] == pytest.approx(2 * leans[1])
    assert leans[2] > 0.5


@pytest.mark.parametrize(("sd_deg", "straight"), [(0.2, True), (6.0, False)])
def test_a_front_whose_sides_may_lean_is_rejected(
    corner: Painted, sd_deg: float, *, straight: bool
) -> None:
    facade, world = corner.matted.facades[0], known_to(corner, sd_deg)
    result = elevation(corner.photo, facade, world, 0, orient.BOTH)
    assert bool(result) == straight
    if isinstance(result, Rejection):
        assert result.reason == "direction unsure"
