"""Holes at the foot of a front: people, cars and posts that stand before it.

The silhouettes are labelled occluders themselves, each scaled to the front and set on
its lowest row.
"""

from collections.abc import Iterator, Sequence
from typing import Any

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Mask

Outline = Float[np.ndarray, "_ 2"]
"""Corners of a silhouette of unit height: feet at y = 0, up is negative, x = 0 amid."""

STANDING = ("person", "vehicle", "placard", "other")
LEAST_PX = 12  # a smaller occluder's outline is too rough to be enlarged


def silhouettes(objects: Sequence[dict[str, Any]]) -> Iterator[Outline]:
    """Take the outlines of a label's people, cars and posts, at unit height."""
    for thing in objects:
        polygon = np.array(thing["polygon"], float)
        height = np.ptp(polygon[:, 1])
        if thing["category"] in STANDING and height > LEAST_PX:
            feet = np.array([polygon[:, 0].mean(), polygon[:, 1].max()])
            yield (polygon - feet) / height


def standing(
    shape: tuple[int, int],
    outlines: Sequence[Outline],
    *,
    rng: np.random.Generator,
) -> Mask:
    """Stand one to four silhouettes on the lowest row, a little sunk at times."""
    h, w = shape
    canvas = np.zeros(shape, np.uint8)
    for _ in range(rng.integers(1, 5)):
        outline = outlines[int(rng.integers(len(outlines)))]
        height = rng.uniform(0.2, 0.75) * h
        foot = [rng.uniform(0, w), h + rng.uniform(0, 0.15) * h]
        points = outline * [height * (1 - 2 * rng.integers(2)), height] + foot
        cv2.fillPoly(canvas, [np.round(points).astype(np.int32)], 1)
    return canvas > 0
