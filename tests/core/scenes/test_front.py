import numpy as np
import pytest

from nostalgin_core.scenes import front
from nostalgin_core.scenes.style import KINDS, STOREYS, FrontStyle, Kind, style_for


@pytest.mark.parametrize("kind", KINDS)
def test_a_texture_has_the_size_of_its_front(kind: Kind) -> None:
    style = style_for(np.random.default_rng(3), width_m=7.5, kind=kind)
    texture = front.paint(style, px_per_m=20.0)
    assert texture.shape == (round(20 * style.height_m), 150)


@pytest.mark.parametrize("kind", KINDS)
def test_the_same_style_paints_the_same_bytes(kind: Kind) -> None:
    style = style_for(np.random.default_rng(4), width_m=9.0, kind=kind)
    assert np.array_equal(
        front.paint(style, px_per_m=20.0), front.paint(style, px_per_m=20.0)
    )


def house(seed: int, kind: Kind) -> FrontStyle:
    return FrontStyle(
        seed=seed,
        kind=kind,
        width_m=7.0,
        storeys=4,
        base_m=4.2,
        crown_m=1.2,
        material="brick",
        albedo=0.5,
        shops=True,
        sun=(0.0, 0.6, 0.8),
    )


def test_two_seeds_paint_two_fronts() -> None:
    one, other = (front.paint(house(k, "tenement"), px_per_m=20.0) for k in (1, 2))
    assert (one != other).mean() > 0.5


def test_windows_are_darker_than_the_wall_between_them() -> None:
    texture = front.paint(house(5, "rowhouse")).astype(float)
    floor = texture[-round(40 * 6.5) : -round(40 * 5.4)]
    columns = floor.mean(axis=0)
    assert np.percentile(columns, 10) < 0.7 * np.percentile(columns, 90)


@pytest.mark.parametrize("seed", range(20))
def test_storeys_stay_within_their_kind(seed: int) -> None:
    style = style_for(np.random.default_rng(seed), width_m=8.0)
    least, most = STOREYS[style.kind]
    assert least <= style.storeys <= most
    assert style.height_m > style.base_m + style.crown_m - 1e-9
