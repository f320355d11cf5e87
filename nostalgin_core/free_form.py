"""Free-form holes: strokes of a brush, as the free-form paper draws them.

A stroke turns by alternating angles and has round joints (Yu et al., "Free-Form Image
Inpainting with Gated Convolution", appendix; the lengths are in shares of the shorter
side, so that a hole looks the same at any size).
"""

import cv2
import numpy as np

from nostalgin_core.arrays import Mask


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
