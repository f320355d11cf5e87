import numpy as np
import pytest

from nostalgin_core.rectify.skyline import over_roof

H, W = 100, 80


def front(*cut: tuple[slice, slice]) -> np.ndarray:
    mask = np.ones((H, W), bool)
    for part in cut:
        mask[part] = False
    return mask


@pytest.mark.parametrize("side", [np.s_[:, :7], np.s_[:, -7:], np.s_[20:, :7]])
def test_a_strip_torn_out_along_a_side_is_no_sky(side: tuple[slice, slice]) -> None:
    assert not over_roof(front(side)).any()


def test_a_foot_torn_out_is_no_sky() -> None:
    assert not over_roof(front(np.s_[80:, 10:50], np.s_[60:, :9])).any()


def test_a_cleft_of_great_depth_is_no_sky() -> None:
    assert not over_roof(front(np.s_[:60, 30:36])).any()


def test_what_hangs_over_the_wall_hides_no_sky() -> None:
    under_a_cornice = front(np.s_[5:, :20])
    assert not over_roof(under_a_cornice).any()


@pytest.mark.parametrize(
    "roof",
    [
        np.s_[:10, 20:26],  # between dormers
        np.s_[:40, 50:],  # a lower wing
        np.s_[:3, :5],  # a rounded corner
        np.s_[:12, :],  # sky all along
    ],
)
def test_the_roof_keeps_its_silhouette(roof: tuple[slice, slice]) -> None:
    mask = front(roof)
    np.testing.assert_array_equal(over_roof(mask), ~mask)


@pytest.mark.parametrize("seed", range(6))
def test_sky_lies_over_the_front_alone(seed: int) -> None:
    mask = np.random.default_rng(seed).random((H, W)) < 0.3
    sky = over_roof(mask)
    assert not (sky & mask).any()
    assert np.all(sky[1:] <= sky[:-1])  # open to the top


def test_columns_without_a_front_end_as_high_as_those_beside_them() -> None:
    mask = front(np.s_[:10, :], np.s_[:, :20])
    sky = over_roof(mask)
    assert sky[:10].all()
    assert not sky[10:].any()


def test_no_front_at_all_is_no_sky() -> None:
    assert not over_roof(np.zeros((H, W), bool)).any()
