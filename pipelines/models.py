"""The networks as callables, checked against their lock, one session a process."""

import hashlib
import json
import os
from collections.abc import Callable
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any, Final

from pipelines import bounded

LOCK: Final = "models.lock"
NETWORKS: Final = ("segment", "inpaint")  # called as the stages that ask them
READER: Final = "placard"  # the stage that asks the reader of print
PRINT: Final = "rapidocr-onnxruntime"  # which it comes with
SHAPES: Final = {"segment": (1, 6), "inpaint": (3, 1)}  # inputs, outputs
PACKAGED: Final = Path(str(resources.files("nostalgin_core") / "models"))


class Unlocked(ValueError):  # noqa: N818 - it reads as what it is about
    """A network that no lock vouches for."""


@dataclass(frozen=True, slots=True)
class Models:
    """A folder with ONNX files and the lock that names their SHA-256.

    Without a name it is that of the package, wherever the process has it installed.
    """

    folder: str = ""

    @property
    def path(self) -> Path:
        """Tell where the folder is in this process."""
        return Path(self.folder) if self.folder else PACKAGED

    def sha256(self, name: str) -> str:
        """Look up what a network's file must hash to.

        Raises:
            Unlocked: if there is no lock, or it does not name this network.
        """
        path = self.path / LOCK
        if not path.is_file():
            raise Unlocked(f"{self.path} has no {LOCK}: name a folder that has one")
        try:
            lock = json.loads(bounded.read(path, bounded.LOCK_BYTES))
        except OSError as problem:
            why = problem.strerror
            raise Unlocked(f"{path}: {why}; name a folder with a lock") from problem
        except (ValueError, RecursionError) as problem:
            why = str(problem)
            raise Unlocked(f"{path} is no JSON ({why}): mend it") from problem
        if not isinstance(lock, dict) or not all(
            isinstance(one, str) for one in lock.values()
        ):
            raise Unlocked(f"{path} must map names of files to their SHA-256")
        if f"{name}.onnx" not in lock:
            raise Unlocked(f"{path} names no {name}.onnx, only {sorted(lock)}")
        return lock[f"{name}.onnx"]

    def load(self, name: str) -> Callable[..., Any]:
        """Load a network, and refuse a file that is not the one the lock names.

        Raises:
            Unlocked: if it is not, or does not run.
        """
        from nostalgin_core import segment, session

        data, lock = self.read(name), self.sha256(name)
        inputs, outputs = SHAPES[name]
        try:
            network = session.load(data, lock, inputs=inputs, outputs=outputs)
            if name == "segment":
                segment.probe(network)
        except (session.ModelBrokenError, segment.Nonsense) as problem:
            raise Unlocked(
                f"{self.path / name}.onnx does not run ({problem}): install "
                "the package again, or export the network anew"
            ) from problem
        return network

    def read(self, name: str) -> bytes:
        """Read a network's file, and refuse one that is not what the lock names.

        Raises:
            Unlocked: if it is missing, or another file than the lock names.
        """
        wanted = self.sha256(name)
        path = self.path / f"{name}.onnx"
        if not path.is_file():
            raise Unlocked(f"{path} is missing: name a folder that has it")
        try:
            data = bounded.read(path, bounded.NETWORK_BYTES)
        except OSError as problem:
            why = problem.strerror
            raise Unlocked(f"{path}: {why}; name a folder that has it") from problem
        if hashlib.sha256(data).hexdigest() != wanted:
            raise Unlocked(
                f"{path} is not the file that {LOCK} names: install the package again, "
                "or write the new checksum if the network was changed on purpose"
            )
        return data

    def networks(self, *, placard: bool) -> Any:
        """Load everything that the plain loop is given."""
        from nostalgin_core.steps import Networks

        read = reader() if placard else None
        segment, inpaint = map(self.load, NETWORKS)
        return Networks(segment, inpaint, read)


class Once:
    """A network, or the reader, loaded when it is first called, once in a process.

    It can be sent to a worker; the network itself stays behind.
    """

    def __init__(self, models: Models, name: str) -> None:
        """Remember which network, and load nothing."""
        from apache_beam.utils.shared import Shared

        self._models, self._name = models, name
        self._shared, self._network = Shared(), None

    def __getstate__(self) -> dict[str, Any]:
        """Leave the network behind."""
        return self.__dict__ | {"_network": None}

    def __call__(self, *arrays: Any) -> Any:
        """Run the network."""
        if self._network is None:
            self._network = self._shared.acquire(self._load)
        return self._network(*arrays)

    def _load(self) -> Callable[..., Any]:
        one_thread()
        return reader() if self._name == READER else self._models.load(self._name)


def reader() -> Callable[..., Any]:
    """Load the reader of number boards, whose networks come with its package.

    Boards are cut out and enlarged before they are read, so nothing is scaled up again:
    the package's default, 736 px for the shorter side, costs ten times as much.
    """
    import numpy as np

    import nostalgin_core.session  # noqa: F401 - it keeps onnxruntime's telemetry off
    from rapidocr_onnxruntime import RapidOCR  # isort: skip

    engine = RapidOCR(
        intra_op_num_threads=1,
        inter_op_num_threads=1,
        det_limit_side_len=640,
        det_limit_type="max",
    )

    def read(image: Any) -> list[tuple[Any, str, float]]:
        found, _ = engine(image, use_cls=False)
        return [
            (np.array(corners, np.float64), str(text), float(score))
            for corners, text, score in found or []
        ]

    return read


def one_thread() -> None:
    """Keep the libraries of this process from starting threads of their own.

    Several workers with a thread each do a fifth more work in the same CPU time than
    the libraries' defaults. And sums that are parted among threads differ in their last
    bits, so that the same input would not give the same bytes. Libraries that are
    loaded already are limited too; those of child processes read the environment.
    """
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ[name] = "1"
    import cv2
    from threadpoolctl import threadpool_limits

    cv2.setNumThreads(1)
    threadpool_limits(1)
