"""A checked ONNX file becomes a plain function from arrays to arrays.

The file's bytes must have the SHA-256 that `models.lock` promises; a network that was
swapped or cut short would otherwise answer, and answer wrongly.
"""

import hashlib
import os
from collections.abc import Callable

import numpy as np

# As it is loaded, onnxruntime makes a device id in the user's cache, and soon it looks
# for its vendor's host. `disable_telemetry_events` comes too late for both.
os.environ["ORT_DISABLE_TELEMETRY"] = "1"
import onnxruntime
from onnxruntime.capi import (
    onnxruntime_pybind11_state as faults,  # pyright: ignore[reportAttributeAccessIssue]
)

Session = Callable[..., tuple[np.ndarray, ...]]


_FAULTS = (
    faults.EPFail,
    faults.Fail,
    faults.InvalidArgument,
    faults.InvalidGraph,
    faults.InvalidProtobuf,
    faults.NoModel,
    faults.NotImplemented,
    faults.RuntimeException,
)


class ModelChangedError(Exception):
    """A model file is not the one that was promised."""


class ModelBrokenError(Exception):
    """A model file is no network that runs, or another than the one that is called."""


def load(
    data: bytes,
    sha256: str,
    *,
    threads: int = 1,
    inputs: int | None = None,
    outputs: int = 1,
) -> Session:
    """Return a function that runs the network on its inputs, in their order.

    If `inputs` is given it has so many, and at least so many `outputs`.

    One thread is right where several processes share the cores. The arena of memory is
    not kept between calls: photographs differ in size, and it would only grow.

    Raises ModelChangedError where the bytes have another checksum, and ModelBrokenError
    where they are no such network.
    """
    found = hashlib.sha256(data).hexdigest()
    if found != sha256:
        raise ModelChangedError(
            f"model has SHA-256 {found}, but {sha256} was promised: install the "
            "package again, or, if the file was retrained on purpose, write its new "
            "checksum to models.lock"
        )
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = threads
    options.inter_op_num_threads = 1
    options.enable_cpu_mem_arena = False
    options.log_severity_level = 3  # warnings are for those who make models
    try:
        runtime = onnxruntime.InferenceSession(
            data, options, providers=["CPUExecutionProvider"]
        )
    except _FAULTS as fault:
        raise ModelBrokenError(str(fault)) from fault
    names = [given.name for given in runtime.get_inputs()]
    made = len(runtime.get_outputs())
    if inputs is not None and (len(names) != inputs or made < outputs):
        raise ModelBrokenError(
            f"it takes {len(names)} inputs and gives {made} outputs, not "
            f"{inputs} and {outputs}"
        )

    def run(*arrays: np.ndarray) -> tuple[np.ndarray, ...]:
        outputs = runtime.run(None, dict(zip(names, arrays, strict=True)))
        return tuple(np.asarray(output) for output in outputs)

    return run
