"""Noise with structure: clouds, streaks and speckles that make a wall look used."""

import cv2
import numpy as np
from jaxtyping import Float

Plane = Float[np.ndarray, "h w"]


def cloud(
    rng: np.random.Generator,
    shape: tuple[int, int],
    *,
    scale_px: float,
    octaves: int = 3,
) -> Plane:
    """Paint smooth noise of mean about 0 and deviation about 1.

    Each octave is white noise, enlarged; it has half the size and 0.6 times the
    strength of the one before.
    """
    # Smooth noise needs few samples: it is made small and enlarged once.
    small = max(1, int(scale_px / 2 ** (octaves + 1)))
    coarse_shape = (shape[0] // small + 2, shape[1] // small + 2)
    if small > 1:
        fine = cloud(rng, coarse_shape, scale_px=scale_px / small, octaves=octaves)
        grown = (coarse_shape[1] * small, coarse_shape[0] * small)
        return cv2.resize(fine, grown, interpolation=cv2.INTER_LINEAR)[
            : shape[0], : shape[1]
        ]
    total = np.zeros(shape, np.float32)
    power = 0.0
    for octave in range(octaves):
        cell = max(scale_px / 2**octave, 1.0)
        size = (max(2, int(shape[1] / cell) + 2), max(2, int(shape[0] / cell) + 2))
        coarse = rng.standard_normal((size[1], size[0]), dtype=np.float32)
        strength = 0.6**octave
        total += strength * cv2.resize(
            coarse, (shape[1], shape[0]), interpolation=cv2.INTER_CUBIC
        )
        power += strength**2
    return total / np.float32(0.75 * np.sqrt(power))


def streaks(
    rng: np.random.Generator, shape: tuple[int, int], *, wide_px: float, long_px: float
) -> Plane:
    """Paint noise drawn out downwards, as rain draws soot."""
    size = (max(2, int(shape[1] / wide_px)), max(2, int(shape[0] / long_px)))
    coarse = rng.standard_normal((size[1], size[0]), dtype=np.float32)
    return cv2.resize(coarse, (shape[1], shape[0]), interpolation=cv2.INTER_LINEAR)
