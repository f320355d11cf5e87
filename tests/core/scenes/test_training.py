import numpy as np

from nostalgin_core.scenes import training

SHAPE = (320, 216)


def test_a_sample_has_targets_and_disjoint_masks() -> None:
    image, things = training.sample(np.random.default_rng(2), SHAPE)
    assert image.shape == SHAPE
    assert any(target for _, _, target in things)
    facades = [mask for category, mask, _ in things if category == "facade"]
    assert np.sum(facades, axis=0).max() == 1
    assert all(mask.any() for _, mask, _ in things)
    assert {category for category, _, _ in things} >= {"facade", "placard"}


def test_fronts_wear_the_textures_that_are_given() -> None:
    stripes = np.tile(np.uint8([[0], [255]]), (150, 260))
    wear = training.wardrobe([stripes])
    styles = [training.pool_style(k) for k in range(40)]
    fitting = [s for s in styles if training.fitting(260 / 300, s.width_m / s.height_m)]
    worn = [wear(style) for style in fitting]
    assert any(np.ptp(t[:, 0]) > 120 and t.shape == stripes.shape for t in worn)
