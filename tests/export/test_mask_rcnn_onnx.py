from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch")
onnx = pytest.importorskip("onnx")
pytest.importorskip("torchvision")

import nostalgin_core  # noqa: E402
from export.mask_rcnn import MaskRCNN, load_weights  # noqa: E402
from export.mask_rcnn_onnx import disparity, export, rounded  # noqa: E402
from export.weights import read_weights, weights_of  # noqa: E402

SHIPPED = Path(nostalgin_core.__file__).parent / "models" / "segment.onnx"


@pytest.fixture(scope="module")
def network() -> MaskRCNN:
    return rounded(load_weights(MaskRCNN(), read_weights(SHIPPED)))


@pytest.fixture(scope="module")
def model(network: MaskRCNN) -> bytes:
    return export(network, _image(160, 128, seed=0))


def _image(height: int, width: int, *, seed: int) -> np.ndarray:
    """A row of dark rectangles before a bright sky: it makes the network look."""
    rng = np.random.default_rng(seed)
    image = np.full((1, 1, height, width), 210, np.float32)
    for x in range(8, width - 30, 40):
        top = int(rng.integers(10, height // 2))
        image[..., top : height - 20, x : x + 30] = rng.uniform(40, 150)
    return image + rng.uniform(0, 20, image.shape).astype(np.float32)


def test_torch_and_onnx_runtime_agree_at_every_size(
    network: MaskRCNN, model: bytes
) -> None:
    sizes = [(160, 128), (96, 224), (320, 256)]
    images = [_image(h, w, seed=i) for i, (h, w) in enumerate(sizes)]
    assert disparity(network, model, images) < 0.05


def test_parity_can_fail(network: MaskRCNN, model: bytes) -> None:
    state = {k: v.numpy().copy() for k, v in network.state_dict().items()}
    state["roi_heads.box_predictor.bbox_pred.bias"] += 0.5
    other = load_weights(MaskRCNN(), state).eval()
    assert disparity(other, model, [_image(320, 256, seed=2)]) > 0.05


def test_training_can_go_on_from_the_shipped_file(
    network: MaskRCNN, model: bytes
) -> None:
    weights = weights_of(onnx.load_from_string(model))
    again = load_weights(MaskRCNN(), weights)
    for name, value in network.state_dict().items():
        assert torch.equal(value, again.state_dict()[name]), name


def test_the_shipped_file_is_small(model: bytes) -> None:
    assert abs(len(model) - SHIPPED.stat().st_size) < 0.02 * len(model)
    assert len(model) < 15e6
