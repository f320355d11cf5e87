import hashlib

import numpy as np
import pytest

from nostalgin_core import session

onnx = pytest.importorskip("onnx")


def _halver() -> bytes:
    """A network of one node: it halves what it is given, of any size."""
    helper, kind = onnx.helper, onnx.TensorProto.FLOAT
    shape = [1, 1, "h", "w"]
    given = helper.make_tensor_value_info("gray", kind, shape)
    made = helper.make_tensor_value_info("half", kind, shape)
    half = helper.make_tensor("half_of_one", kind, [], [0.5])
    node = helper.make_node("Mul", ["gray", "half_of_one"], ["half"])
    graph = helper.make_graph([node], "halver", [given], [made], [half])
    opset = [helper.make_opsetid("", 17)]
    model = helper.make_model(graph, opset_imports=opset, ir_version=8)
    return model.SerializeToString()


def test_a_session_is_a_function_from_arrays_to_arrays() -> None:
    data = _halver()
    run = session.load(data, hashlib.sha256(data).hexdigest())
    for height, width in ((2, 3), (5, 4)):
        gray = np.arange(height * width, dtype=np.float32).reshape(1, 1, height, width)
        (half,) = run(gray)
        np.testing.assert_array_equal(half, gray / 2)


def test_a_swapped_model_is_refused_and_the_remedy_named() -> None:
    data = _halver()
    with pytest.raises(session.ModelChangedError, match=r"models\.lock"):
        session.load(data, hashlib.sha256(data + b" ").hexdigest())


def test_a_model_cut_short_is_refused() -> None:
    data = _halver()
    with pytest.raises(session.ModelChangedError):
        session.load(data[:-1], hashlib.sha256(data).hexdigest())


def test_a_session_wants_as_many_arrays_as_it_has_inputs() -> None:
    data = _halver()
    run = session.load(data, hashlib.sha256(data).hexdigest())
    with pytest.raises(ValueError, match="zip"):
        run()
