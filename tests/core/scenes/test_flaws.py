"""Flaws: none by default, alike for the same front, and a lens that can be undone."""

from dataclasses import replace

import numpy as np
import pytest

from nostalgin_core import scenes
from nostalgin_core.scenes import flaws, lens, surface, viewpoint
from nostalgin_core.scenes.style import style_for

SHAPE = (210, 140)
STYLE = style_for(np.random.default_rng(3), width_m=8.0)


def test_a_front_strays_by_what_is_asked_for_and_always_alike() -> None:
    size = np.array([STYLE.width_m, STYLE.height_m])[:, None, None]
    one, other = (flaws.stray(STYLE, 0.01) * size for _ in range(2))
    np.testing.assert_array_equal(one, other)
    assert 0.008 < one.std() < 0.04
    np.testing.assert_allclose(flaws.stray(STYLE, 0.02) * size, 2 * one)


@pytest.mark.parametrize("k", [0.0, 0.008, -0.02])
def test_what_a_lens_bends_can_be_straightened(k: float) -> None:
    rng = np.random.default_rng(0)
    points = rng.uniform([-300, -300], [500, 500], (40, 2))
    shown = flaws.bent(points, SHAPE, k)
    np.testing.assert_allclose(flaws.pinhole(shown, SHAPE, k), points, atol=1e-6)
    middle = (np.array(SHAPE[::-1]) - 1) / 2
    nearer = np.linalg.norm(shown - middle, axis=1) - np.linalg.norm(
        points - middle, axis=1
    )
    assert np.all(nearer * np.sign(k) <= 1e-9)


def test_a_bent_canvas_shows_a_point_where_it_is_said_to() -> None:
    canvas = surface.empty(SHAPE)
    canvas.tone[20:23, 110:113] = 200
    seen = flaws.bend(canvas, 0.05).tone
    y, x = np.mgrid[0 : SHAPE[0], 0 : SHAPE[1]]
    found = np.array([(x * seen).sum(), (y * seen).sum()]) / seen.sum()
    (wanted,) = flaws.bent(np.array([[111.0, 21.0]]), SHAPE, 0.05)
    np.testing.assert_allclose(found, wanted, atol=0.1)
    assert np.linalg.norm(wanted - [111.0, 21.0]) > 2


def drawn(stray: np.ndarray | None) -> surface.Canvas:
    """Draw one wall of stripes."""
    camera = lens.aim(
        np.array([0.0, -12.0, 1.6]),
        yaw_deg=8.0,
        tilt_deg=6.0,
        roll_deg=0.0,
        focal_px=160.0,
        principal_px=(69.5, 104.5),
    )
    canvas = surface.empty(SHAPE)
    axes = np.array([[8.0, 0.0, 0.0], [0.0, 0.0, 9.0]])
    panel = surface.Panel(np.array([-4.0, 0.0, 0.0]), axes, 0, stray)
    stripes = np.tile(np.arange(90)[:, None] // 10 % 2 * 120 + 60, (1, 80))
    assert surface.draw(canvas, camera, panel, lambda: stripes.astype(np.uint8))
    return canvas


def test_a_drawing_that_does_not_stray_is_the_even_one() -> None:
    even, still = drawn(None), drawn(np.zeros((2, 20, 20)))
    np.testing.assert_array_equal(even.label, still.label)
    assert np.abs(even.tone - still.tone).mean() < 1.0


def test_what_strays_downwards_lowers_the_roof_alone() -> None:
    even, lower = drawn(None), drawn(np.full((2, 20, 20), 0.05))
    was, now = even.label == 0, lower.label == 0
    assert not np.any(now & ~was)
    assert 0.03 < 1 - now.sum() / was.sum() < 0.07
    assert (
        np.flatnonzero(now.any(axis=1)).max() == np.flatnonzero(was.any(axis=1)).max()
    )


def test_a_flawed_photo_is_of_the_same_street() -> None:
    town = scenes.neighbourhood(np.random.default_rng(11), blocks=1)
    lot = town.blocks[0].lots[0]  # at the corner of the south and the west
    town = replace(town, blocks=(replace(town.blocks[0], lots=(lot,)),), around=())
    stripes = np.tile(np.arange(90)[:, None] // 10 % 2 * 120 + 60, (1, 80))
    shape = (120, 80)
    corners = np.array([viewpoint.corners_m(wall) for wall in lot.walls if wall.front])
    camera = lens.aim(
        np.array([*corners.mean(axis=(0, 1))[:2], 1.6]) - [0.0, 16.0, 0.0],
        yaw_deg=5.0,
        tilt_deg=8.0,
        roll_deg=0.0,
        focal_px=96.0,
        principal_px=(39.5, 59.5),
    )
    plain, flawed = (
        scenes.photograph(
            town,
            lot,
            np.random.default_rng(5),
            shape=shape,
            camera=camera,
            wear=lambda _: stripes.astype(np.uint8),
            flawed=flaw,
        )
        for flaw in (scenes.Flaws(), scenes.Flaws(stray_m=0.01, barrel=0.01))
    )
    assert not np.array_equal(plain.image, flawed.image)
    ours, theirs = (
        {one.front_id: one for one in photo.truth.facades} for photo in (plain, flawed)
    )
    assert ours.keys() == theirs.keys()
    for name, one in ours.items():
        np.testing.assert_array_equal(
            one.vanishing_points, theirs[name].vanishing_points
        )
        off = np.linalg.norm(one.quad - theirs[name].quad, axis=1)
        assert np.all(off <= 0.011 * np.linalg.norm(one.quad, axis=1).max() + 2)
        both = one.amodal & theirs[name].amodal
        assert both.sum() > 0.9 * (one.amodal | theirs[name].amodal).sum()
