from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch")
pytest.importorskip("onnx")

from export.remembered import remembered


class _Counting:
    def __init__(self) -> None:
        self.asked = 0

    def __call__(self, gray: np.ndarray) -> tuple[np.ndarray, ...]:
        self.asked += 1
        return np.array([self.asked]), gray[0, 0] / 2


def test_what_was_asked_once_is_answered_alike_without_asking(tmp_path: Path) -> None:
    network = _Counting()
    gray = np.arange(12, dtype=np.float32).reshape(1, 1, 3, 4)
    first = remembered(network, tmp_path, "a")(gray)
    again = remembered(network, tmp_path, "a")(gray.copy())
    assert network.asked == 1
    assert all(map(np.array_equal, first, again))
    assert [one.dtype for one in first] == [one.dtype for one in again]


def test_another_picture_shape_or_network_is_asked_about(tmp_path: Path) -> None:
    network = _Counting()
    gray = np.arange(12, dtype=np.float32).reshape(1, 1, 3, 4)
    remembered(network, tmp_path, "a")(gray)
    remembered(network, tmp_path, "a")(gray + 1)
    remembered(network, tmp_path, "a")(gray.reshape(1, 1, 4, 3))
    remembered(network, tmp_path, "b")(gray)
    assert network.asked == 4
