"""Holes to learn on: people, cars and posts standing at the foot of a front.

The silhouettes are the labelled occluders themselves, each scaled to the front and set
on its lowest row. Free-form strokes are drawn by `nostalgin_core.free_form`.
"""

import json
from pathlib import Path

import cv2
import numpy as np

from nostalgin_core.arrays import Mask, Points

Outline = Points  # unit height, feet at y = 0, upwards negative, centred on x = 0

STANDING = ("person", "vehicle", "placard", "other")


def outlines(data: Path) -> tuple[Outline, ...]:
    """Read the silhouettes of all labelled people, cars and posts, block 993's not."""
    found = []
    for folder in ("taxphotos", "historic_streets"):
        for path in sorted((data / folder / "labels").glob("*.json")):
            if path.stem.startswith("00993"):
                continue
            for thing in json.loads(path.read_text())["objects"]:
                polygon = np.array(thing["polygon"], float)
                height = np.ptp(polygon[:, 1])
                if thing["category"] in STANDING and height > 12:
                    feet = np.array([polygon[:, 0].mean(), polygon[:, 1].max()])
                    found.append((polygon - feet) / height)
    return tuple(found)


def standing(
    shape: tuple[int, int],
    silhouettes: tuple[Outline, ...],
    *,
    rng: np.random.Generator,
) -> Mask:
    """Stand one to four silhouettes on the lowest row, a little sunk at times."""
    h, w = shape
    canvas = np.zeros(shape, np.uint8)
    for _ in range(rng.integers(1, 5)):
        outline = silhouettes[rng.integers(len(silhouettes))]
        height = rng.uniform(0.2, 0.75) * h
        foot = [rng.uniform(0, w), h + rng.uniform(0, 0.15) * h]
        points = outline * [height * (1 - 2 * rng.integers(2)), height] + foot
        cv2.fillPoly(canvas, [np.round(points).astype(np.int32)], 1)
    return canvas > 0
