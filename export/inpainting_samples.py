"""A sample is a crop of a front, a hole in it, and a guess to start from.

Every sample is drawn from a given generator, so that a step seeded by its number sees
the same ones whether or not a training was cut off before it.
"""

from dataclasses import dataclass

import cv2
import numpy as np
import torch
from torch import Tensor

from export.inpainting_data import Kind, Sheet
from export.masks import Outline, standing
from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.inpaint.repetition import guess
from nostalgin_core.measure.free_form import free_form_share

AT_FOOT = 0.5  # share of holes that are silhouettes at the foot, the harder kind


@dataclass(frozen=True, slots=True, eq=False)
class Sample:
    """One crop with a hole; scored where the hole was made and the truth is known."""

    image: Gray
    hole: Mask
    scored: Mask
    guess: Gray  # made from more of the picture than the crop


def guessed(image: Gray, hole: Mask) -> Gray:
    """Guess what a hole hides, as the pipeline does."""
    made = guess(np.where(hole, 0, image).astype(np.float32), hole)
    return np.clip(np.round(made), 0, 255).astype(np.uint8)


def scaled(sheet: Sheet, least: int, *, rng: np.random.Generator) -> tuple[Gray, Mask]:
    """Give a picture at a random size, its shorter side at least so long."""
    image, known = sheet.image, sheet.known
    scale = max(least / min(image.shape), rng.uniform(0.4, 1.0))
    shape = [max(least, round(n * scale)) for n in image.shape]
    small = cv2.resize(image, shape[::-1], interpolation=cv2.INTER_AREA)
    seen = known.astype(np.uint8)
    seen = cv2.resize(seen, shape[::-1], interpolation=cv2.INTER_NEAREST) > 0
    if rng.random() < 0.5:
        small, seen = small[:, ::-1], seen[:, ::-1]
    return np.ascontiguousarray(small), np.ascontiguousarray(seen)


def within(hole: Mask, size: int, *, rng: np.random.Generator) -> tuple[int, int]:
    """Choose the crop's top left so that a hidden texel lies in it."""
    y, x = np.argwhere(hole)[rng.integers(hole.sum())]
    low = [max(0, n - size + 1) for n in (int(y), int(x))]
    high = [min(n, m - size) for n, m in zip((int(y), int(x)), hole.shape, strict=True)]
    top, left = (rng.integers(a, b + 1) for a, b in zip(low, high, strict=True))
    return int(top), int(left)


def draw(
    pictures: tuple[Sheet, ...],
    silhouettes: tuple[Outline, ...],
    size: int,
    *,
    rng: np.random.Generator,
) -> Sample:
    """Make a hole in one picture and crop a part of it.

    The guess is made on a window of at most twice the crop's size, since a front that
    repeats does so over more than a crop.
    """
    sheet = pictures[rng.integers(len(pictures))]
    image, known = scaled(sheet, size, rng=rng)
    shape = [min(n, 2 * size) for n in image.shape]
    at_foot = rng.random() < AT_FOOT
    y = image.shape[0] - shape[0]
    y = y if at_foot else rng.integers(y + 1)
    x = rng.integers(image.shape[1] - shape[1] + 1)
    window = np.s_[y : y + shape[0], x : x + shape[1]]
    image, known = image[window], known[window]
    if at_foot:
        hole = standing(image.shape, silhouettes, rng=rng)
    else:
        hole = free_form_share(image.shape, least=rng.uniform(0.05, 0.3), rng=rng)
    if not (hole & known).any() or (known & ~hole).mean() < 0.15:
        return draw(pictures, silhouettes, size, rng=rng)
    made = guessed(image, hole | ~known)
    top, left = within(hole & known, size, rng=rng)
    crop = np.s_[top : top + size, left : left + size]
    return Sample(image[crop], (hole | ~known)[crop], (hole & known)[crop], made[crop])


def tensors(samples: list[Sample]) -> tuple[Tensor, Tensor, Tensor, Tensor]:
    """Stack samples as image, hole, guess and scored, images from -1 to 1."""
    stacks = [
        np.stack([getattr(sample, name) for sample in samples]).astype(np.float32)
        for name in ("image", "hole", "guess", "scored")
    ]
    for index in (0, 2):
        stacks[index] = stacks[index] / 127.5 - 1
    image, hole, guesses, scored = (torch.from_numpy(a)[:, None] for a in stacks)
    return image, hole, guesses, scored


def mixture(
    seed: tuple[int, int],
    pictures: tuple[Sheet, ...],
    silhouettes: tuple[Outline, ...],
    *,
    shares: dict[Kind, float],
    count: int,
    crop: int,
) -> list[Sample]:
    """Draw the samples of one step, the same ones every time for a seed.

    `shares` says how often each kind of picture is drawn, if there is any of it.
    """
    rng = np.random.default_rng(seed)
    kinds = [(s, tuple(p for p in pictures if p.kind == k)) for k, s in shares.items()]
    pools = [pool for share, pool in kinds if pool and share > 0]
    odds = np.array([share for share, pool in kinds if pool and share > 0])
    return [
        draw(
            pools[rng.choice(len(pools), p=odds / odds.sum())],
            silhouettes,
            crop,
            rng=rng,
        )
        for _ in range(count)
    ]
