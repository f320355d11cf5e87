from pathlib import Path

import cv2
import numpy as np

from export.pseudo_labels import (
    UNSURE,
    VIEWS,
    clusters,
    layers,
    read_pseudo,
    unlabelled,
)
from nostalgin_core.records import Box, Instance
from tests.outdoors import outdoors

SHAPE = (416, 416)
FRONT = (60.0, 100.0, 200.0, 380.0)  # in pixels of the photo; so is what stands by it


def front(score: float, *, shift: int = 0) -> Instance:
    mask = np.ones((100, 60), np.float32)
    return Instance("facade", score, Box(40 + shift, 50, 100 + shift, 150), mask)


def test_what_most_views_say_is_believed_and_the_rest_doubted() -> None:
    sure = [[front(0.9)], [front(0.8, shift=3)], [front(0.7, shift=-2)], []]
    (cluster,) = clusters(sure)
    assert cluster.believed
    assert cluster.score == sum((0.9, 0.8, 0.7)) / len(VIEWS)
    (alone,) = clusters([[front(0.9)], [], [], []])
    assert not alone.believed
    assert len(clusters([[front(0.9)], [front(0.9, shift=50)], [], []])) == 2


def test_one_view_has_one_voice() -> None:
    twice = [[front(0.9), front(0.8, shift=1)], [], [], []]
    assert sorted(len(c.said) for c in clusters(twice)) == [1, 1]


def fickle(gray: np.ndarray) -> tuple[np.ndarray, ...]:
    """Find the front in every view; a car, at another place, in the first alone."""
    height = gray.shape[2]
    scale = height / SHAPE[0]
    mirrored = gray[0, 0, 0, 0] > gray[0, 0, 0, -1]
    x0, y0, x1, y1 = FRONT
    if mirrored:
        x0, x1 = SHAPE[1] - x1, SHAPE[1] - x0
    boxes = [np.array([x0, y0, x1, y1]) * scale]
    labels, scores = [1], [0.9]
    if height == SHAPE[0] and not mirrored:
        boxes.append(np.array([250, 300, 350, 380]) * scale)
        labels.append(3)
        scores.append(0.8)
    masks = np.ones((len(boxes), 8, 8), np.float32)
    pixels = np.full((4, *(side // 4 for side in gray.shape[-2:])), 0.5, np.float32)
    return (
        np.array(boxes),
        np.array(labels),
        np.array(scores),
        masks,
        pixels,
        outdoors(gray),
    )


def test_layers_mirror_back_and_mark_what_is_doubted() -> None:
    ramp = np.tile(np.linspace(0, 255, SHAPE[1]).astype(np.uint8), (SHAPE[0], 1))
    stack = layers(ramp, fickle)
    assert sorted(int(s.max()) for s in stack) == [1, 3 + UNSURE]
    believed = next(s for s in stack if s.max() == 1)
    ys, xs = np.nonzero(believed)
    found = np.array([xs.min(), ys.min(), xs.max() + 1, ys.max() + 1])
    np.testing.assert_allclose(found, FRONT, atol=3)


def test_only_photos_without_labels_are_asked_about_and_read_back(
    tmp_path: Path,
) -> None:
    for name in ("photos", "labels", "pseudo"):
        (tmp_path / name).mkdir()
    for stem in ("known", "new", "empty"):
        cv2.imwrite(str(tmp_path / f"photos/{stem}.jpg"), np.zeros(SHAPE, np.uint8))
    (tmp_path / "labels/known.json").write_text("{}")
    assert [p.stem for p in unlabelled(tmp_path)] == ["empty", "new"]
    stack = np.zeros((2, *SHAPE), np.uint8)
    stack[0, 50:90, 40:80] = 1
    stack[1, 200:240, 40:80] = 3 + UNSURE
    np.savez_compressed(tmp_path / "pseudo/new.npz", layers=stack)
    np.savez_compressed(tmp_path / "pseudo/empty.npz", layers=stack[1:])
    (sample,) = read_pseudo(tmp_path / "photos", tmp_path / "pseudo")
    said = [(t.category, t.scored, t.layer) for t in sample.things]
    assert said == [("facade", True, 0), ("vehicle", False, 0)]
