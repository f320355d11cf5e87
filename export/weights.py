"""Named weights are read back from whatever they were kept in.

Training goes on from the shipped ONNX file: it keeps the names of `state_dict`, and no
other copy of the weights is needed.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import onnx
import torch
from onnx import numpy_helper

GENERATOR = "generator."  # begins the names of the inpainter's weights
BRANCH = "branch."  # begins the names of the semantic branch's weights
INDOORS = "indoors."  # begins the names of the head's that tells rooms from streets
PARTS = (
    "backbone",
    "rpn",
    "roi_heads",
    BRANCH,
    INDOORS,
    GENERATOR,
)  # what else was folded
CAST = "|half"  # ends the names of weights that an ONNX file stores in half precision


def read_weights(path: Path) -> dict[str, np.ndarray]:
    """Read `.npz`, an exported `.onnx`, or the averaged weights of a checkpoint."""
    if path.suffix == ".pt":
        average = torch.load(path, weights_only=True, map_location="cpu")["average"]
        return {name: value.cpu().numpy() for name, value in average.items()}
    if path.suffix == ".onnx":
        return weights_of(onnx.load(str(path)))
    with np.load(path) as arrays:
        return {name: arrays[name] for name in arrays.files}


def mean_weights(parts: Sequence[str]) -> dict[str, np.ndarray]:
    """Mix networks that went on from one start: the mean of their weights.

    A part is a path, or a path with its share behind an `@`, as in `segment.onnx@3`.
    Wortsman et al., "Model soups", ICML 2022: the mean of several runs' or steps'
    weights tends to do better than each, at no cost in use.

    Raises:
        ValueError: if a share is no positive number.
    """
    shares, networks = [], []
    for part in parts:
        path, at, share = part.partition("@")
        shares.append(float(share) if at else 1.0)
        networks.append(read_weights(Path(path)))
    if min(shares) <= 0:
        raise ValueError(f"shares must be positive: {shares}")
    odds = np.array(shares) / sum(shares)

    def mixed(name: str) -> np.ndarray:
        arrays = [network[name].astype(np.float64) for network in networks]
        return np.einsum("n,n...->...", odds, np.stack(arrays)).astype(np.float32)

    return {name: mixed(name) for name in networks[0]}


def weights_of(model: onnx.ModelProto) -> dict[str, np.ndarray]:
    """Read the named weights of an exported network, in the precision kept."""
    arrays = {w.name: numpy_helper.to_array(w) for w in model.graph.initializer}
    named = {name.removesuffix(CAST): array for name, array in arrays.items()}
    return {name: a for name, a in named.items() if name.startswith(PARTS)}
