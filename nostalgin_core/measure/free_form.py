"""Free-form holes: strokes of a brush, as the free-form paper draws them.

A stroke turns by alternating angles and has round joints (Yu et al., "Free-Form Image
Inpainting with Gated Convolution", appendix; the lengths are in shares of the shorter
side, so that a hole looks the same at any size).
"""

import cv2
import numpy as np

from nostalgin_core.arrays import Mask

REFUSED = 100  # strokes in a row; one in three or so fits into a tenth of a picture


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
    shape: tuple[int, int],
    *,
    least: float,
    most: float = 1.0,
    rng: np.random.Generator,
) -> Mask:
    """Draw strokes until at least a share of the picture is covered.

    A stroke that would cover more than `most` is drawn anew. Where most is reached only
    by strokes of a few texels, as in a tiny picture, the last stroke tried is taken.
    """
    hole = np.zeros(shape, bool)
    refused = 0
    while hole.mean() < least:
        more = hole | free_form(shape, rng=rng)
        if more.mean() <= most or refused == REFUSED:
            hole, refused = more, 0
        else:
            refused += 1
    return hole
