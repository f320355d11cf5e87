import numpy as np
import pytest

pytest.importorskip("torch")
pytest.importorskip("onnx")

from export.fit_target import Fronts, fit, fronts, right
from nostalgin_core.segment import CATEGORIES
from tests.export.painted_segmentation import painted
from tests.outdoors import outdoors


def _photos(seed: int, count: int = 240) -> list[Fronts]:
    """Photos of four fronts, of which the one nearest to the board is recorded."""
    rng = np.random.default_rng(seed)
    made = []
    for _ in range(count):
        rows = np.column_stack([np.ones(4), rng.random((4, 6))])
        made.append((rows, rows[:, 2] == rows[:, 2].min()))
    return made


def test_the_fit_finds_what_tells_the_recorded_front() -> None:
    weights = fit(_photos(0))
    others = np.abs(weights[[1, 3, 4, 5, 6]])
    assert weights[2] < -3 * others.max()
    assert right(_photos(1), weights) > 0.8  # by chance: 0.25


def test_right_counts_the_photos_whose_best_front_is_recorded() -> None:
    rows = np.eye(7)[[1, 2]]
    photos = [(rows, np.array([True, False])), (rows, np.array([False, True]))]
    assert right(photos, np.array([0, 1.0, 0, 0, 0, 0, 0])) == 0.5


def test_fronts_are_weighed_as_found() -> None:
    def network(gray: np.ndarray) -> tuple[np.ndarray, ...]:
        height, width = gray.shape[-2:]
        boxes = np.array([[0.05, 0.16, 0.4, 0.78], [0.6, 0.25, 0.78, 0.78]], np.float32)
        labels = np.full(2, CATEGORIES.index("facade") + 1)
        scores = np.array([0.8, 0.7], np.float32)
        scale = np.array([width, height] * 2, np.float32)
        masks = np.ones((2, 28, 28), np.float32)
        kinds = np.array([0.05, 0.9, 0.05, 0.0], np.float32)[:, None, None]
        pixels = np.tile(kinds, (1, height // 4, width // 4))
        return boxes * scale, labels, scores, masks, pixels, outdoors(gray)

    ((rows, recorded),) = fronts([painted()], network)
    assert rows.shape == (2, 7)
    assert recorded.tolist() == [True, False]
    assert rows[0, 4] == pytest.approx(0.8)
