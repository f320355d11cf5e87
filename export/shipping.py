"""A traced network becomes the file that ships: simplified, halved, checked, locked.

What the tracer wrote down of sizes and constants is folded, which halves the time that
opening a file takes. Large weights are kept in half precision and cast on loading; all
reckoning stays in single. Weights keep their names, so that training goes on from the
shipped file.
"""

import hashlib
import json
from pathlib import Path

import numpy as np
import onnx
import onnxslim
from onnx import TensorProto, helper, numpy_helper

from export.weights import CAST

SMALLEST_HALVED = 64  # biases weigh nothing and stay exact


def shipped(traced: bytes, *, facts: dict[str, str] | None = None) -> bytes:
    """Return a traced network as the file's bytes, with `facts` as its metadata."""
    slim = onnxslim.slim(onnx.load_from_string(traced))
    if not isinstance(slim, onnx.ModelProto):
        raise TypeError("onnxslim gave back no model")
    model = halved(slim)
    helper.set_model_props(model, facts or {})
    onnx.checker.check_model(model, full_check=True)
    return model.SerializeToString()


def halved(model: onnx.ModelProto) -> onnx.ModelProto:
    """Store the large weights in half precision, with a cast where they are used."""
    casts = []
    for weight in model.graph.initializer:
        array = numpy_helper.to_array(weight)
        if weight.data_type != TensorProto.FLOAT or array.size < SMALLEST_HALVED:
            continue
        name = weight.name
        half = numpy_helper.from_array(array.astype(np.float16), name + CAST)
        weight.CopyFrom(half)
        casts.append(helper.make_node("Cast", [name + CAST], [name], to=1))
    nodes = [*casts, *model.graph.node]
    del model.graph.node[:]
    model.graph.node.extend(nodes)
    return model


def lock(path: Path, model: bytes) -> None:
    """Write a model, and its SHA-256 to the `models.lock` beside it.

    Other entries are left as they are.
    """
    path.write_bytes(model)
    locked = path.with_name("models.lock")
    sums = json.loads(locked.read_text()) if locked.exists() else {}
    sums[path.name] = hashlib.sha256(model).hexdigest()
    locked.write_text(json.dumps(dict(sorted(sums.items())), indent=2) + "\n")
