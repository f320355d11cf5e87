"""Painted streets as a measure: the perfect measures zero, the kept is as the fresh."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from nostalgin_core import homography, scenes
from nostalgin_core.records import Box, Elevation, Facade, Matted, Photo, Rejection
from nostalgin_core.rectify import camera
from nostalgin_core.scenes import lens
from pipelines.evaluate import painted, rectification_table, streets

FRAME = Box(0, 0, 640, 480)
CAMERA = camera.matrix(680.0, FRAME)
QUAD = np.array([[100.0, 80.0], [300.0, 120.0], [300.0, 400.0], [100.0, 440.0]])
ASPECT = 0.9


def scene(*, complete: bool = True) -> painted.Painted:
    """One front whose truth is known."""
    mask = np.zeros((480, 640), bool)
    facade = Facade(0, 1.0, True, 1.0, mask, mask, mask * np.float32(1))  # noqa: FBT003
    return painted.Painted(
        Photo("0" * 16, np.zeros((480, 640), np.uint8), FRAME),
        Matted((facade,), ()),
        QUAD[None],
        np.array([[[900.0, 260.0, 1.0], [0.0, 1.0, 0.0]]]),
        np.array([ASPECT]),
        np.array([complete]),
        CAMERA,
    )


def perfect() -> Elevation:
    """Find what is true, and state a deviation for each quantity."""
    edges = np.array([[0.0, 0.0], [90.0, 0.0], [90.0, 100.0], [0.0, 100.0]]) - 0.5
    nothing = np.zeros((100, 90), np.uint8)
    return Elevation(
        facade=0,
        image=nothing,
        alpha=nothing.astype(np.float32),
        evidence=nothing,
        quad=QUAD,
        photo_from_elevation=homography.between(edges, QUAD),
        vanishing_points=np.array([[-1800.0, -520.0, -2.0], [0.0, 7.0, 0.0]]),
        focal_px=680.0,
        aspect=ASPECT,
        vanishing_sd_deg=(0.5, 0.25),
        focal_sd_px=13.6,
        aspect_sd=0.009,
        method="two vanishing points",
    )


def test_a_perfect_answer_measures_zero() -> None:
    (found,) = streets.outlined(scene(), (perfect(),))
    figures = (found.corners_px, found.corners_percent, found.aspect_percent)
    assert figures == pytest.approx((0, 0, 0), abs=1e-9)
    assert found.worst_deg < 1e-5
    residuals = streets.stated(scene(), (perfect(),))
    assert [one.quantity for one in residuals] == list(streets.QUANTITIES)
    assert [one.error for one in residuals] == pytest.approx([0] * 4, abs=1e-6)
    assert [one.sd for one in residuals] == pytest.approx([0.5, 0.25, 2.0, 1.0])


def test_a_camera_turned_by_a_degree_errs_by_a_degree() -> None:
    turn = np.radians(1.0)
    turned = np.array([0.0, np.cos(turn), np.sin(turn)]) @ CAMERA.T
    points = np.vstack([perfect().vanishing_points[0], turned])
    one = replace(perfect(), vanishing_points=points)
    errors = {r.quantity: r.error for r in streets.stated(scene(), (one,))}
    assert errors["vertical"] == pytest.approx(1.0, abs=1e-6)
    assert errors["horizontal"] == pytest.approx(0.0, abs=1e-6)


def test_wrong_proportions_and_corners_err_by_what_they_are_off() -> None:
    one = replace(perfect(), aspect=ASPECT * 1.05, quad=QUAD + np.array([6.0, -8.0]))
    (found,) = streets.outlined(scene(), (one,))
    assert found.aspect_percent == pytest.approx(5.0)
    assert found.corners_px == pytest.approx(10.0)
    width = (np.hypot(200, 40) + np.hypot(200, 40)) / 2
    assert found.corners_percent == pytest.approx(1000 / width)


def test_cut_and_rejected_fronts_have_no_outline() -> None:
    assert streets.outlined(scene(complete=False), (perfect(),)) == []
    refused = Rejection("0" * 16, "rectify", "too few lines", facade=0)
    assert streets.outlined(scene(), (refused,)) == []
    assert streets.stated(scene(), (refused,)) == []
    assert streets.summed([])["corners_px_median"] is None


def test_what_a_photos_fronts_share_counts_once() -> None:
    one = scene()
    two = replace(
        one,
        matted=Matted(one.matted.facades * 2, ()),
        quads=np.repeat(one.quads, 2, axis=0),
        vanishing_points=np.repeat(one.vanishing_points, 2, axis=0),
        aspects=np.repeat(one.aspects, 2),
        complete=np.repeat(one.complete, 2),
    )
    residuals = streets.stated(two, (perfect(), perfect()))
    counts = {q: sum(r.quantity == q for r in residuals) for q in streets.QUANTITIES}
    assert counts == {"horizontal": 2, "vertical": 1, "focal": 1, "aspect": 2}


def test_coverage_is_told_for_all_and_for_each_way_a_direction_was_found() -> None:
    residuals = [
        streets.Residual("focal", "a", error, 1.0) for error in (0.5, -1.0, 3.0)
    ] + [streets.Residual("focal", "b", 0.1, 1.0)]
    table = streets.covered(residuals)
    assert list(table) == ["focal"]
    assert {name: row["count"] for name, row in table["focal"].items()} == {
        "all": 4,
        "a": 3,
        "b": 1,
    }
    assert table["focal"]["a"]["share"] == pytest.approx(2 / 3)
    lines = rectification_table.coverage(table)
    assert len(lines) == 4
    assert "75.0" in lines[1]


def test_a_kept_painting_measures_what_a_fresh_one_does(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = []

    def photograph(_: object, lot: scenes.Lot, *__: object, **___: object) -> object:
        made.append(lot.lot)
        return tiny(int(lot.lot))

    monkeypatch.setattr(scenes, "photograph", photograph)
    fresh = list(painted.paintings(3, seed=7, keep=tmp_path))
    kept = list(painted.paintings(3, seed=7, keep=tmp_path))
    assert len(made) == len(fresh) == len(kept) == 3
    for one, other in zip(fresh, kept, strict=True):
        assert one.photo.key == other.photo.key
        np.testing.assert_array_equal(one.quads, other.quads)
        np.testing.assert_array_equal(one.camera, other.camera)
        (before,), (after,) = one.matted.facades, other.matted.facades
        np.testing.assert_array_equal(before.alpha, after.alpha)
        np.testing.assert_array_equal(before.amodal, after.amodal)
        assert before.target == after.target


def tiny(number: int) -> scenes.PaintedPhoto:
    """Stand in for a painted photo: a front that counts, and one too small."""
    rng = np.random.default_rng(number)
    image = rng.integers(0, 255, (60, 40)).astype(np.uint8)
    whole, speck = np.zeros((2, 60, 40), bool)
    whole[10:50, 5:30], speck[2, 2] = True, True
    points = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    fronts = tuple(
        scenes.TrueFacade(
            f"1-{number}-0",
            target=True,
            visible=mask,
            amodal=mask,
            alpha=rng.random((60, 40)).astype(np.float32) * mask,
            quad=QUAD / 10 + number,
            vanishing_points=points,
            aspect=0.6,
            width_m=6.0,
            height_m=10.0,
            texture=image,
            m_per_px=0.1,
            photo_from_texture=np.eye(3),
            complete=True,
        )
        for mask in (whole, speck)
    )
    eye = lens.Camera(50.0 + number, (19.5, 29.5), np.eye(3), np.zeros(3))
    rest = np.zeros((60, 40), np.float32)
    truth = scenes.Truth(eye, fronts, (), rest, "", Box(0, 0, 40, 60))
    return scenes.PaintedPhoto(f"{number}", image, truth)
