"""A street of rectangles with known outlines, small enough to train on in a test."""

import numpy as np

from export.segmentation_data import Sample, Thing


def rectangle(x0: float, y0: float, x1: float, y1: float) -> tuple[np.ndarray]:
    return (np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], float),)


def painted(seed: int = 0, *, size: tuple[int, int] = (128, 128)) -> Sample:
    """Two fronts, a far row and a car before them."""
    rng = np.random.default_rng(seed)
    image = np.full(size, 200, np.uint8)
    split = int(rng.integers(50, 70))
    things = [
        Thing("facade", rectangle(6, 20, split, 100), 0, target=True),
        Thing("facade", rectangle(split + 1, 30, 100, 100), 0),
        Thing("facade", rectangle(104, 50, 124, 100), 0, scored=False),
        Thing("vehicle", rectangle(30, 84, 76, 112), 1),
    ]
    for tone, thing in zip((120, 160, 180, 30), things, strict=True):
        x0, y0 = thing.rings[0].min(0).astype(int)
        x1, y1 = thing.rings[0].max(0).astype(int) + 1
        image[y0:y1, x0:x1] = tone
    noise = rng.integers(0, 20, size)
    return Sample(f"painted {seed}", (image + noise).astype(np.uint8), tuple(things))
