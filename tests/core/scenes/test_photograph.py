from dataclasses import replace

import cv2
import numpy as np
import pytest

from nostalgin_core import homography, scenes
from nostalgin_core.scenes import viewpoint
from nostalgin_core.scenes.lot import Wall

SHAPE = (840, 560)


@pytest.fixture(scope="module")
def town() -> scenes.Neighbourhood:
    return scenes.neighbourhood(np.random.default_rng(11), blocks=1)


def lot_of(town: scenes.Neighbourhood, fronts: int) -> scenes.Lot:
    return next(
        lot
        for block in town.blocks
        for lot in block.lots
        if len(lot.fronts) == fronts and not lot.ruined
    )


@pytest.fixture(scope="module", params=[1, 2], ids=["street lot", "corner lot"])
def photo(
    town: scenes.Neighbourhood, request: pytest.FixtureRequest
) -> scenes.PaintedPhoto:
    lot = lot_of(town, request.param)
    return scenes.photograph(town, lot, np.random.default_rng(5), shape=SHAPE)


def wall_of(town: scenes.Neighbourhood, front_id: str) -> Wall:
    return next(
        wall
        for block in (*town.blocks, *town.around)
        for lot in block.lots
        for wall in lot.walls
        if wall.front and wall.front.front_id == front_id
    )


def test_every_target_front_is_in_its_photo(
    town: scenes.Neighbourhood, photo: scenes.PaintedPhoto
) -> None:
    block, lot = photo.truth.placard_text.removesuffix(" M").split(" -")
    own = {
        front.front_id
        for each in town.blocks
        for place in each.lots
        if (place.block, place.lot) == (block, lot)
        for front in place.fronts
    }
    found = {facade.front_id for facade in photo.truth.facades if facade.target}
    assert found == own


def test_quads_are_the_walls_corners_seen_through_the_camera(
    town: scenes.Neighbourhood, photo: scenes.PaintedPhoto
) -> None:
    camera = photo.truth.camera
    projection = camera.matrix @ np.column_stack(
        [camera.rotation, camera.translation_m]
    )
    for facade in photo.truth.facades:
        corners = viewpoint.corners_m(wall_of(town, facade.front_id))
        lifted = np.column_stack([corners, np.ones(4)]) @ projection.T
        np.testing.assert_allclose(facade.quad, lifted[:, :2] / lifted[:, 2:])


def test_opposite_edges_meet_at_the_vanishing_points(
    photo: scenes.PaintedPhoto,
) -> None:
    for facade in photo.truth.facades:
        tl, tr, br, bl = np.column_stack([facade.quad, np.ones(4)])
        for true, edges in zip(
            facade.vanishing_points,
            (((tl, tr), (bl, br)), ((tl, bl), (tr, br))),
            strict=True,
        ):
            meet = np.cross(np.cross(*edges[0]), np.cross(*edges[1]))
            meet /= np.linalg.norm(meet)
            assert abs(meet @ true) == pytest.approx(1.0, abs=1e-9)


def test_aspect_and_focal_length_agree_with_the_quad(
    photo: scenes.PaintedPhoto,
) -> None:
    unit = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    for facade in photo.truth.facades:
        columns = (
            np.linalg.inv(photo.truth.camera.matrix)
            @ homography.between(unit, facade.quad)[:, :2]
        )
        across, down = np.linalg.norm(columns, axis=0)
        assert across / down == pytest.approx(facade.aspect, rel=1e-9)
        assert facade.aspect == pytest.approx(facade.width_m / facade.height_m)
        assert columns[:, 0] @ columns[:, 1] == pytest.approx(0.0, abs=1e-9)


def test_facades_never_overlap(photo: scenes.PaintedPhoto) -> None:
    for kind in ("visible", "amodal"):
        masks = [getattr(facade, kind) for facade in photo.truth.facades]
        assert np.sum(masks, axis=0).max() <= 1


def test_visible_is_amodal_less_what_stands_before_it(
    photo: scenes.PaintedPhoto,
) -> None:
    before = np.sum([thing.alpha for thing in photo.truth.occluders], axis=0)
    for facade in photo.truth.facades:
        assert not (facade.visible & ~facade.amodal).any()
        hidden = facade.amodal & ~facade.visible
        assert (before[hidden] > 0.24).all()
        assert not (facade.visible & (before > 0.501)).any()


def test_the_shares_of_light_sum_to_one(photo: scenes.PaintedPhoto) -> None:
    truth = photo.truth
    shares = [thing.alpha for thing in (*truth.facades, *truth.occluders)]
    total = np.sum(shares, axis=0)
    assert total.max() < 1 + 1e-5
    np.testing.assert_allclose(total + truth.rest, 1.0, atol=1e-5)


def test_masks_fill_their_quads(photo: scenes.PaintedPhoto) -> None:
    for facade in photo.truth.facades:
        if not facade.target:
            continue
        drawn = np.zeros(SHAPE, np.uint8)
        cv2.fillPoly(drawn, [np.round(facade.quad).astype(np.int32)], 1)
        frame = photo.truth.frame
        clipped = np.zeros_like(drawn)
        clipped[frame.y0 : frame.y1, frame.x0 : frame.x1] = 1
        quad = (drawn & clipped) > 0
        both = (quad & facade.amodal).sum() / (quad | facade.amodal).sum()
        assert both > 0.96


def test_straightening_the_photo_gives_the_texture_back(
    photo: scenes.PaintedPhoto,
) -> None:
    for facade in photo.truth.facades:
        if not facade.target:
            continue
        h, w = facade.texture.shape
        back = np.linalg.inv(facade.photo_from_texture)
        straight = cv2.warpPerspective(photo.image, back, (w, h)).astype(float)
        seen = cv2.warpPerspective(facade.alpha, back, (w, h)) > 0.99
        clean = cv2.GaussianBlur(facade.texture, (0, 0), 1.5).astype(float)
        assert np.corrcoef(straight[seen], clean[seen])[0, 1] > 0.8
        shifted = np.roll(clean, (12, 12), axis=(0, 1))
        assert np.corrcoef(straight[seen], shifted[seen])[0, 1] < 0.6


def test_the_same_seed_takes_the_same_photo(town: scenes.Neighbourhood) -> None:
    lot = lot_of(town, 1)
    one, other = (
        scenes.photograph(town, lot, np.random.default_rng(8), shape=(420, 280))
        for _ in range(2)
    )
    assert one.image.tobytes() == other.image.tobytes()
    assert len(one.truth.facades) == len(other.truth.facades)


def test_a_photo_holds_a_number_board(photo: scenes.PaintedPhoto) -> None:
    boards = [thing for thing in photo.truth.occluders if thing.category == "placard"]
    assert len(boards) == 1
    assert boards[0].mask.sum() > 800


def test_outside_the_frame_nothing_is_a_facade(photo: scenes.PaintedPhoto) -> None:
    frame = photo.truth.frame
    outside = np.ones(SHAPE, bool)
    outside[frame.y0 : frame.y1, frame.x0 : frame.x1] = False
    for facade in photo.truth.facades:
        assert not (facade.amodal & outside).any()
    assert np.median(photo.image[outside]) < 40


def test_a_ruined_photo_shows_no_front(town: scenes.Neighbourhood) -> None:
    lot = replace(lot_of(town, 1), ruined=True)
    photo = scenes.photograph(town, lot, np.random.default_rng(1), shape=(420, 280))
    assert photo.truth.facades == ()
    assert np.ptp(cv2.GaussianBlur(photo.image[60:-60, 60:-60], (0, 0), 9)) < 120


@pytest.mark.parametrize("shape", [(420, 280), (280, 420)])
def test_photos_come_in_any_shape(
    town: scenes.Neighbourhood, shape: tuple[int, int]
) -> None:
    photo = scenes.photograph(
        town, lot_of(town, 1), np.random.default_rng(2), shape=shape
    )
    assert photo.image.shape == shape
    assert any(facade.target for facade in photo.truth.facades)


def test_the_album_follows_the_catalogue(town: scenes.Neighbourhood) -> None:
    photos = scenes.album(town, seed=3, shape=(210, 140))
    rows = scenes.catalogue_rows(town)
    for row, photo in zip(rows[:2], photos, strict=False):
        assert photo.name == row["File Name "]
