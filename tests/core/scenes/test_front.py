import numpy as np
import pytest

from nostalgin_core.scenes import front


@pytest.mark.parametrize("kind", front.KINDS)
def test_a_texture_has_the_size_of_its_front(kind: front.Kind) -> None:
    style = front.style(np.random.default_rng(3), width_m=7.5, kind=kind)
    texture = front.paint(style, px_per_m=20.0)
    assert texture.shape == (round(20 * style.height_m), 150)


@pytest.mark.parametrize("kind", front.KINDS)
def test_the_same_style_paints_the_same_bytes(kind: front.Kind) -> None:
    style = front.style(np.random.default_rng(4), width_m=9.0, kind=kind)
    assert np.array_equal(
        front.paint(style, px_per_m=20.0), front.paint(style, px_per_m=20.0)
    )


def test_two_seeds_paint_two_fronts() -> None:
    one, other = (
        front.paint(
            front.FrontStyle(
                seed, "tenement", 8.0, 5, 4.2, 1.2, "brick", 0.4, True, (0.0, 0.6, 0.8)
            ),
            px_per_m=20.0,
        )
        for seed in (1, 2)
    )
    assert (one != other).mean() > 0.5


def test_windows_are_darker_than_the_wall_between_them() -> None:
    style = front.FrontStyle(
        5, "rowhouse", 7.0, 4, 4.2, 1.2, "brick", 0.5, True, (0.0, 0.6, 0.8)
    )
    texture = front.paint(style).astype(float)
    floor = texture[-round(40 * 6.5) : -round(40 * 5.4)]
    columns = floor.mean(axis=0)
    assert np.percentile(columns, 10) < 0.7 * np.percentile(columns, 90)


@pytest.mark.parametrize("seed", range(20))
def test_storeys_stay_within_their_kind(seed: int) -> None:
    style = front.style(np.random.default_rng(seed), width_m=8.0)
    least, most = front.STOREYS[style.kind]
    assert least <= style.storeys <= most
    assert style.height_m > style.base_m + style.crown_m - 1e-9
