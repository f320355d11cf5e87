"""A clean scan ages: it fades, blurs, gets grain, scratches and a black border.

Each kind of wear comes with its own chance, so that many training photos stay as they
are. Outlines do not move.
"""

import cv2
import numpy as np

from nostalgin_core.arrays import Gray


def wear(image: Gray, rng: np.random.Generator) -> Gray:
    """Age an image by a random choice of what eighty years do."""
    aged = image.astype(np.float32)
    if rng.random() < 0.7:
        aged = _fade(aged, rng)
    if rng.random() < 0.3:
        aged = cv2.GaussianBlur(aged, (0, 0), rng.uniform(0.4, 1.6))
    if rng.random() < 0.3:
        aged = _light(aged, rng)
    if rng.random() < 0.3:
        aged += rng.normal(0, rng.uniform(2, 10), aged.shape).astype(np.float32)
    if rng.random() < 0.2:
        _scratch(aged, rng)
    if rng.random() < 0.15:
        _frame(aged, rng)
    return np.clip(np.round(aged), 0, 255).astype(np.uint8)


def _fade(image: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Bend the tones by a gamma and squeeze them between a new black and white."""
    bent = 255 * (np.clip(image, 0, 255) / 255) ** np.exp(rng.uniform(-0.5, 0.5))
    black, white = rng.uniform(0, 50), rng.uniform(190, 255)
    return black + bent * ((white - black) / 255)


def _light(image: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Lay a slow gradient over the image, as an uneven print has it."""
    coarse = rng.uniform(0.7, 1.25, (3, 3)).astype(np.float32)
    return image * cv2.resize(coarse, image.shape[::-1], interpolation=cv2.INTER_CUBIC)


def _scratch(image: np.ndarray, rng: np.random.Generator) -> None:
    """Draw a few thin, nearly upright lines, white or black."""
    height, width = image.shape
    for _ in range(int(rng.integers(1, 6))):
        x, y = rng.uniform(0, width), rng.uniform(0, height)
        end = x + rng.normal(0, 20), y + rng.uniform(20, height)
        tone = float(rng.choice([10.0, 245.0]))
        cv2.line(image, (int(x), int(y)), (int(end[0]), int(end[1])), tone, 1)


def _frame(image: np.ndarray, rng: np.random.Generator) -> None:
    """Blacken a border of unequal width, as a scanned film's."""
    height, width = image.shape
    top, below, left, right = rng.integers(0, 20, 4)
    tone = rng.uniform(0, 25)
    image[:top] = image[height - below :] = tone
    image[:, :left] = image[:, width - right :] = tone
