import numpy as np
import pytest

pytest.importorskip("torch")
pytest.importorskip("onnx")

import torch

from export.held_out import as_callable
from export.mask_rcnn import MaskRCNN
from export.rare import KINDS
from export.rare_exam import fates, scenes, sharing
from tests.export.painted_segmentation import painted
from tests.outdoors import outdoors

SAMPLES = [painted(seed) for seed in range(6)]


def silent(gray: np.ndarray) -> tuple[np.ndarray, ...]:
    """Find nothing."""
    height, width = gray.shape[-2:]
    pixels = np.full((4, height // 4, width // 4), 0.3, np.float32)
    none = np.zeros(0, np.float32)
    masks = np.zeros((0, 46, 46), np.float32)
    return (
        np.zeros((0, 4), np.float32),
        none.astype(np.int64),
        none,
        masks,
        pixels,
        outdoors(gray),
    )


@pytest.mark.parametrize("kind", KINDS)
def test_scenes_are_the_same_every_time_and_ask_for_what_a_kind_touched(
    kind: str,
) -> None:
    one, two = (scenes(SAMPLES, kind, most=3) for _ in range(2))
    assert len(one) <= 3
    for a, b in zip(one, two, strict=True):
        np.testing.assert_array_equal(a.sample.image, b.sample.image)
        assert a.visible
        assert len(a.visible) == len(b.visible)
        before = next(s for s in SAMPLES if s.name == a.sample.name)
        assert (a.sample.image != before.image).any()


def test_squeezing_touches_every_front_and_a_marquee_only_some() -> None:
    for scene in scenes(SAMPLES, "grazing", most=6):
        assert not scene.others
    asked = scenes(SAMPLES, "marquee", most=6)
    assert any(scene.others for scene in asked)  # a marquee hangs before one of two


def test_what_nothing_is_found_of_is_missed() -> None:
    (scene, *_) = scenes(SAMPLES, "grazing", most=1)
    assert fates(silent, scene) == {"missed": len(scene.visible)}


def test_networks_that_share_a_backbone_answer_as_each_would_alone() -> None:
    torch.manual_seed(0)
    first, second = MaskRCNN().eval(), MaskRCNN().eval()
    second.backbone.load_state_dict(first.backbone.state_dict())
    gray = np.random.default_rng(0).uniform(0, 255, (1, 1, 64, 96)).astype(np.float32)
    alone = [as_callable(n)(gray) for n in (first, second)]
    shared = sharing([first, second])
    for network, before in zip((first, second), alone, strict=True):
        for a, b in zip(as_callable(network)(gray), before, strict=True):
            np.testing.assert_array_equal(a, b)
    assert len(shared.made) == 1


def test_networks_of_other_backbones_do_not_share() -> None:
    torch.manual_seed(0)
    with pytest.raises(ValueError, match="backbone"):
        sharing([MaskRCNN(), MaskRCNN()])
