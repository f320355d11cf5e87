"""What a network said of a picture once need not be asked again.

Answers are kept in a folder, by the network's own checksum and the picture's bytes, so
that what is fitted to hundreds of photographs can be fitted again in seconds.
"""

import hashlib
import os
from pathlib import Path

import numpy as np

from export.mask_rcnn_onnx import locked, open_shipped
from nostalgin_core.segment import Network


def shipped(answers: Path | None) -> Network:
    """Open the network that ships, with a folder of what it said, if one is given."""
    network = open_shipped()
    return network if answers is None else remembered(network, answers, locked())


def remembered(network: Network, folder: Path, version: str) -> Network:
    """Return a network that answers from the folder where it can.

    Args:
        network: Asked where the folder knows nothing.
        folder: Holds an answer a file; made if it is not there.
        version: Of the network: what another said is not taken for its answer.
    """
    folder.mkdir(parents=True, exist_ok=True)

    def call(gray: np.ndarray) -> tuple[np.ndarray, ...]:
        told = f"{version} {gray.shape} {gray.dtype} ".encode()
        name = hashlib.sha256(told + np.ascontiguousarray(gray).tobytes()).hexdigest()
        path = folder / f"{name}.npz"
        if path.exists():
            with np.load(path) as kept:
                return tuple(kept[f"arr_{i}"] for i in range(len(kept.files)))
        answer = network(gray)
        partial = path.with_suffix(f".{os.getpid()}.partial.npz")  # two may ask at once
        np.savez_compressed(partial, *answer)
        partial.replace(path)
        return answer

    return call
