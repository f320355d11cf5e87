import hashlib
import io
import json
import warnings
from pathlib import Path

import numpy as np
import onnx
import pytest
import torch

from export.shipping import lock, shipped
from export.weights import CAST
from nostalgin_core import session


@pytest.fixture(scope="module")
def traced() -> bytes:
    """Trace a small network that reckons with sizes."""

    class Doubled(torch.nn.Module):
        def __init__(self) -> None:
            super().__init__()
            self.conv = torch.nn.Conv2d(1, 16, 3, padding=1)

        def forward(self, x: torch.Tensor) -> torch.Tensor:
            h, w = x.shape[-2:]
            size = (h * 2, w * 2)
            return torch.nn.functional.interpolate(self.conv(x), size=size)

    torch.manual_seed(0)
    written = io.BytesIO()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        torch.onnx.export(
            Doubled().eval(),
            (torch.rand(1, 1, 8, 12),),
            written,  # pyright: ignore[reportArgumentType] - it takes a buffer
            input_names=["x"],
            dynamic_axes={"x": {2: "h", 3: "w"}},
            do_constant_folding=False,
            dynamo=False,
        )
    return written.getvalue()


def test_what_ships_answers_as_what_was_traced_at_any_size(traced: bytes) -> None:
    for size in ((8, 12), (5, 9)):
        x = np.random.default_rng(1).normal(size=(1, 1, *size)).astype(np.float32)
        (want,) = opened(traced)(x)
        (got,) = opened(shipped(traced))(x)
        assert got.shape == (1, 16, 2 * size[0], 2 * size[1])
        np.testing.assert_allclose(got, want, atol=2e-3)


def test_what_ships_is_simpler_halved_named_and_repeats(traced: bytes) -> None:
    made = shipped(traced, facts={"steps": "3"})
    model, before = onnx.load_from_string(made), onnx.load_from_string(traced)
    names = {w.name: w.data_type for w in model.graph.initializer}
    assert len(model.graph.node) < len(before.graph.node)
    assert names["conv.weight" + CAST] == onnx.TensorProto.FLOAT16
    assert names["conv.bias"] == onnx.TensorProto.FLOAT
    assert [(p.key, p.value) for p in model.metadata_props] == [("steps", "3")]
    assert shipped(traced, facts={"steps": "3"}) == made


def test_a_lock_keeps_what_it_promised_of_others(tmp_path: Path) -> None:
    lock(tmp_path / "one.onnx", b"first")
    lock(tmp_path / "two.onnx", b"second")
    lock(tmp_path / "one.onnx", b"third")
    sums = json.loads((tmp_path / "models.lock").read_text())
    assert list(sums) == ["one.onnx", "two.onnx"]
    assert (tmp_path / "one.onnx").read_bytes() == b"third"
    with pytest.raises(session.ModelChangedError):
        session.load(b"first", sums["one.onnx"])


def opened(model: bytes) -> session.Session:
    """Open a network with the checksum it has."""
    return session.load(model, hashlib.sha256(model).hexdigest())
