import numpy as np
import pytest

from nostalgin_core.scenes import relief


def ledge() -> relief.Board:
    """A wall of 4 m with a ledge standing out 0.5 m, from 3.0 to 3.2 m up."""
    board = relief.blank(2.0, 4.0, px_per_m=40.0)
    relief.box(board, (0.0, 3.0, 2.0, 3.2), relief_m=0.5)
    return board


def test_a_flat_wall_has_no_shadow() -> None:
    board = relief.blank(2.0, 3.0, px_per_m=40.0)
    assert relief.shadow(board, (-0.5, 0.6, 0.62)).max() == 0.0


@pytest.mark.parametrize("up", [0.5, 0.7])
def test_a_shadow_is_as_long_as_the_suns_height_makes_it(up: float) -> None:
    out = float(np.sqrt(1 - up * up))
    dark = relief.shadow(ledge(), (0.0, up, out))
    below = dark[40:, 40]  # from the ledge's foot down
    long_m = (below > 0.5).sum() / 40.0
    assert long_m == pytest.approx(0.5 * up / out, abs=0.08)


def test_a_sun_straight_ahead_casts_no_shadow() -> None:
    assert relief.shadow(ledge(), (0.0, 0.0, 1.0)).max() == 0.0


def test_a_shadow_falls_away_from_the_sun() -> None:
    dark = relief.shadow(ledge(), (0.0, 0.6, 0.8))
    assert dark[:30].max() == 0.0
    assert dark[42:45].min() > 0.5


def test_a_lit_wall_is_lighter_than_one_in_the_shade() -> None:
    board = ledge()
    sunny = relief.light(board, (0.3, 0.6, 0.74), ambient=0.42)
    shady = relief.light(board, (0.3, 0.6, -0.74), ambient=0.42)
    assert sunny.mean() > 1.5 * shady.mean()


def test_a_box_covers_the_pixels_of_its_metres() -> None:
    board = relief.blank(2.0, 3.0, px_per_m=40.0)
    relief.box(board, (0.5, 1.0, 1.0, 2.0), albedo=1.0)
    drawn = board.albedo == 1.0
    assert drawn.sum() == 20 * 40
    assert drawn[40:80, 20:40].all()
