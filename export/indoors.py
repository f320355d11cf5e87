"""A head on the backbone tells rooms from streets.

What the backbone's two deepest taps (strides 16 and 32) make of a photograph is brought
to one grid at stride 32, where each cell has its say whether it was taken indoors: one
convolution of 1 x 1. It learns by itself (`export/fit_indoors.py`), since there are few
photographs of rooms, and nothing else of the network changes for it.
"""

from collections.abc import Mapping
from typing import Final

import torch
from torch import Tensor, nn
from torch.nn import functional

SHALLOW: Final = ("2", 96)  # the tap at stride 16, and its channels
DEEP: Final = ("3", 320)  # at stride 32


class Indoors(nn.Module):
    """The head: a logit a cell of 32 x 32 pixels, whose mean counts."""

    def __init__(self) -> None:
        """Begin by knowing nothing."""
        super().__init__()
        self.say = nn.Conv2d(SHALLOW[1] + DEEP[1], 1, 1)
        nn.init.zeros_(self.say.weight)
        nn.init.zeros_(torch.as_tensor(self.say.bias))

    def forward(self, taps: Mapping[str, Tensor]) -> Tensor:
        """Map taps to logits (n, 1, h / 32, w / 32)."""
        return self.say(features(taps))


def features(taps: Mapping[str, Tensor]) -> Tensor:
    """Lay the two deepest taps over each other, (n, 416, h / 32, w / 32)."""
    return torch.cat([functional.avg_pool2d(taps[SHALLOW[0]], 2), taps[DEEP[0]]], 1)
