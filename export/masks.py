"""Holes to learn on: free-form strokes, and people and cars standing at the foot.

Free-form strokes follow the algorithm of the free-form paper (appendix): a brush that
turns by alternating angles, with round joints. Silhouettes are the labelled occluders
themselves, each scaled to the front and set on its lowest row.
"""

import json
from pathlib import Path

import cv2
import numpy as np

from nostalgin_core.arrays import Mask, Points

Outline = Points  # unit height, feet at y = 0, upwards negative, centred on x = 0

STANDING = ("person", "vehicle", "placard", "other")


def free_form(shape: tuple[int, int], *, rng: np.random.Generator) -> Mask:
    """Draw one brush stroke of several joints."""
    h, w = shape
    size = min(shape)
    canvas = np.zeros(shape, np.uint8)
    x, y = rng.uniform(0, w), rng.uniform(0, h)
    width = rng.uniform(0.06, 0.22) * size
    mean = rng.uniform(0, 2 * np.pi)
    for vertex in range(rng.integers(3, 9)):
        angle = mean + rng.uniform(-0.5, 0.5) + (np.pi if vertex % 2 else 0)
        angle += rng.uniform(-0.9, 0.9)
        length = rng.uniform(0.1, 0.5) * size
        to_x = float(np.clip(x + length * np.cos(angle), 0, w - 1))
        to_y = float(np.clip(y + length * np.sin(angle), 0, h - 1))
        joint = (round(to_x), round(to_y))
        cv2.line(canvas, (round(x), round(y)), joint, 1, max(round(width), 2))
        cv2.circle(canvas, joint, max(round(width / 2), 1), 1, -1)
        x, y = to_x, to_y
    return canvas > 0


def free_form_share(
    shape: tuple[int, int], *, least: float, rng: np.random.Generator
) -> Mask:
    """Draw strokes until at least a share of the picture is covered."""
    hole = np.zeros(shape, bool)
    while hole.mean() < least:
        hole |= free_form(shape, rng=rng)
    return hole


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
