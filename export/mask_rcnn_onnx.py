"""The trained network leaves torch as one ONNX file, and proves that it is the same.

The legacy exporter is used because the newer one fails in torchvision's non-maximum
suppression.

    python -m export.mask_rcnn_onnx --weights CHECKPOINT --into segment.onnx
"""

import argparse
import hashlib
import io
import json
import warnings
from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
import torch
from jaxtyping import Float32

import nostalgin_core
from export.mask_rcnn import MaskRCNN, load_weights
from export.shipping import SMALLEST_HALVED, lock, shipped
from export.weights import mean_weights
from nostalgin_core import session
from nostalgin_core.segment.segment import prepared

_MODELS = Path(nostalgin_core.__file__).parent / "models"
SHIPPED = _MODELS / "segment.onnx"
OPSET = 17
THINGS = ("boxes", "labels", "scores", "masks")
PLANES = ("pixels", "indoors")
OUTPUTS = (*THINGS, *PLANES)
TOLERANCE = 0.05  # px, and hundredths of that in scores: rounding, added up


def export(network: MaskRCNN, example: Float32[np.ndarray, "1 1 h w"]) -> bytes:
    """Return the network as ONNX, for images of any size in multiples of 32.

    The example should show things of every size, though only shapes are traced.
    """
    buffer = io.BytesIO()
    with warnings.catch_warnings():  # the tracer tells of every size it sees
        warnings.simplefilter("ignore")
        torch.onnx.export(
            network.eval(),
            (torch.from_numpy(example),),
            buffer,  # pyright: ignore[reportArgumentType] (the stub knows paths only)
            opset_version=OPSET,
            input_names=["gray"],
            output_names=list(OUTPUTS),
            dynamic_axes={"gray": {2: "h", 3: "w"}}
            | {name: {0: "n"} for name in THINGS}
            | {name: {1: f"{name}_h", 2: f"{name}_w"} for name in PLANES},
            do_constant_folding=False,
            dynamo=False,
        )
    return shipped(buffer.getvalue())


def rounded(network: MaskRCNN) -> MaskRCNN:
    """Round a network's weights as the file will keep them."""
    state = {k: v.numpy() for k, v in network.state_dict().items()}
    half = {
        k: v.astype(np.float16) if v.size >= SMALLEST_HALVED else v
        for k, v in state.items()
    }
    return load_weights(MaskRCNN(), half).eval()


@torch.inference_mode()
def disparity(
    network: MaskRCNN, model: bytes, images: Sequence[Float32[np.ndarray, "1 1 h w"]]
) -> float:
    """Return the largest difference of boxes (in px), scores or probabilities.

    It is infinite where the two do not find the same number of the same things.
    """
    ours = session.load(model, hashlib.sha256(model).hexdigest())
    worst = 0.0
    for image in images:
        want = [part.numpy() for part in network(torch.from_numpy(image))]
        got = ours(image)
        if want[1].tolist() != got[1].tolist():
            return float("inf")
        parts = zip(want, got, strict=True)
        worst = max(worst, *(float(np.abs(a - b).max(initial=0)) for a, b in parts))
    return worst


def open_shipped() -> session.Session:
    """Open the network that ships with the core, checked against its lock."""
    return session.load(SHIPPED.read_bytes(), locked())


def locked() -> str:
    """Return the checksum that the network which ships is promised to have."""
    return json.loads((_MODELS / "models.lock").read_text())["segment.onnx"]


def main() -> None:
    """Export, prove parity on labelled photographs, write the file and its lock."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--weights", nargs="+", required=True, help=".npz, .onnx or .pt; their mean"
    )
    parser.add_argument("--photos", type=Path, nargs="+", required=True)
    parser.add_argument("--into", type=Path, required=True)
    args = parser.parse_args()
    network = rounded(load_weights(MaskRCNN(), mean_weights(args.weights)))
    images = [_image(path) for path in args.photos]
    model = export(network, images[0])
    worst = disparity(network, model, images)
    if not worst < TOLERANCE:
        raise SystemExit(f"the exported network differs by {worst}; nothing written")
    lock(args.into, model)
    print(f"{args.into}: {len(model) / 1e6:.1f} MB, differs by {worst:.2g} at most")


def _image(path: Path) -> Float32[np.ndarray, "1 1 h w"]:
    gray = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    if gray is None:
        raise ValueError(f"not a picture: {path}")
    return prepared(gray, short_px=640, long_px=1344)[None, None]


if __name__ == "__main__":
    main()
