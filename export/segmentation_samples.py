"""What a step of training sees: photographs, dressed up, with what should be answered.

Everything random about a step is seeded from its number.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from export.blemishes import blemished
from export.cells import Cells, cells
from export.copy_paste import Donor, paste
from export.rare import MIXED, rare
from export.segmentation_data import (
    UNSCORED,
    Sample,
    Truth,
    tilted,
    truth,
    view,
)
from export.wear import wear
from nostalgin_core.arrays import Gray
from nostalgin_core.records import Category
from nostalgin_core.segment import CATEGORIES


@dataclass(frozen=True, slots=True)
class Schedule:
    """How long and how fast to learn.

    The rate rises over `warm_up` steps and falls along half a cosine to a hundredth.
    1e-4 with Adam is usual for weights that already know the task. Losses of `batch`
    photos make one step. Gradients are clipped to norm 10 (paper, appendix).
    """

    steps: int = 2000
    rate: float = 1e-4
    warm_up: int = 50
    batch: int = 2
    clip: float = 10.0
    decay: float = 0.995  # of the average: about the last 200 steps
    short_px: tuple[int, int] = (352, 544)  # between which a photo's short side falls
    seed: int = 0
    answering: tuple[Category, ...] = CATEGORIES  # the paper's two networks share these
    branch_only: bool = False  # all else stays as it is, boxes and masks to the bit
    boxes_only: bool = False  # proposals and boxes learn; features, masks, branch stay
    dropout: float = 0.0  # share of what boxes are told apart by that is lost a step
    rare: float = 0.0  # share of photos that are made one of a rare kind
    kinds: tuple[str, ...] = MIXED  # of which these are drawn

    def rate_at(self, step: int) -> float:
        """Return the learning rate of a step."""
        rise = min(1.0, (step + 1) / self.warm_up)
        fall = 0.5 * (1 + math.cos(math.pi * min(1.0, step / self.steps)))
        return self.rate * rise * (0.01 + 0.99 * fall)


@dataclass(frozen=True, slots=True, eq=False)
class Seen:
    """One photo as the network is shown it, and what it should answer."""

    image: Gray
    answer: Truth
    cells: Cells

    def tensors(self, device: torch.device) -> tuple[Tensor, list[dict[str, Tensor]]]:
        """Give both to torch."""
        gray = torch.from_numpy(self.image.astype(np.float32))[None, None]
        target = {
            "boxes": torch.from_numpy(self.answer.boxes).to(device),
            "labels": torch.from_numpy(self.answer.labels).to(device),
            "masks": torch.from_numpy(self.answer.masks.astype(np.uint8)).to(device),
            "cells": torch.from_numpy(self.cells)[None].to(device),
        }
        return gray.to(device, memory_format=torch.channels_last), [target]


def drawn(
    pools: Sequence[Sequence[Sample]],
    cut: Sequence[Donor],
    step: int,
    schedule: Schedule,
) -> list[Seen]:
    """Draw the photos of one step, the same ones every time."""
    rngs = [
        np.random.default_rng([schedule.seed, step, turn])
        for turn in range(schedule.batch)
    ]
    return [dressed(pools, cut, rng, schedule) for rng in rngs]


def dressed(
    pools: Sequence[Sequence[Sample]],
    cut: Sequence[Donor],
    rng: np.random.Generator,
    schedule: Schedule,
) -> Seen:
    """Draw one photo, dress it up, and return it with what should be answered.

    It comes from a pool drawn evenly, so that a small pool is not drowned.
    """
    short_px = schedule.short_px
    wanted = [CATEGORIES.index(name) + 1 for name in schedule.answering]
    while True:
        pool = pools[int(rng.integers(len(pools)))]
        sample = view(pool[int(rng.integers(len(pool)))], rng, short_px=short_px)
        if rng.random() < 0.5:
            sample = tilted(sample, rng)
        if schedule.rare and rng.random() < schedule.rare:
            sample = rare(sample, rng, schedule.kinds)
        if rng.random() < 0.5:
            sample = paste(sample, cut, rng)
        sample = blemished(sample, rng)
        answer = truth(sample)
        if np.isin(answer.labels, wanted).any():
            break
    kept = np.isin(answer.labels, [*wanted, UNSCORED])
    parts = answer.boxes[kept], answer.labels[kept], answer.masks[kept]
    return Seen(wear(sample.image, rng), Truth(*parts), cells(sample))
