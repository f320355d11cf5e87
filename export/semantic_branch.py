"""A semantic branch tells every pixel what it is, beside the network's few things.

Kirillov et al., "Panoptic Feature Pyramid Networks", CVPR 2019, section 3.1, made
small: the pyramid's five levels of 128 channels (strides 4 to 64) are brought to 64
channels each, those of strides 8 to 64 are added up at stride 8, where most of the work
is done, and stride 4 joins them at the end. The backbone's taps of strides 8, 16 and 32
are added as they are, since a pyramid that was made for boxes need not hold all that
single pixels ask for; they begin with weights of 0.

Output: at stride 4, the probabilities of ground, front and what hides it, which sum to
1, and that of an end of a front (`probabilities`).
"""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
import torch
from torch import Tensor, nn
from torch.nn import functional

KINDS: Final = 3  # ground, front, what hides it
WIDTH: Final = 64
GROUPS: Final = 8
TAPPED: Final = {"1": 32, "2": 96, "3": 320}  # the backbone's taps and their channels
ENDS: Final = 0.5  # the weight of the ends' loss
RARE: Final = 4.0  # how much more an end weighs than what is none
TRIAL: Final = {"a.": "levels.", "b.": "middle.", "c.": "top."}  # the first trial's


class GroupNorm(nn.Module):
    """Group normalisation (Wu and He, ECCV 2018) whose weights an ONNX file can name.

    They have the shape that they are used in, so that no exporter folds them away.
    """

    def __init__(self, channels: int) -> None:
        """Begin by changing nothing after normalising."""
        super().__init__()
        self.weight = nn.Parameter(torch.ones(channels, 1, 1))
        self.bias = nn.Parameter(torch.zeros(channels, 1, 1))

    def forward(self, x: Tensor) -> Tensor:
        """Normalise each group of channels of each photo, then scale and shift."""
        return functional.group_norm(x, GROUPS) * self.weight + self.bias


class SemanticBranch(nn.Module):
    """The branch: four logits a cell of 4 x 4 pixels."""

    def __init__(self, channels: int = 128) -> None:
        """Start with the taps of the backbone silent."""
        super().__init__()
        self.levels = nn.ModuleList([_layer(channels) for _ in range(5)])
        self.taps = nn.ModuleList([_silent(wide) for wide in TAPPED.values()])
        self.middle = nn.Sequential(*_layer(WIDTH), *_layer(WIDTH))
        self.top = nn.Sequential(*_layer(WIDTH), nn.Conv2d(WIDTH, KINDS + 1, 1))

    @property
    def learning(self) -> bool:
        """Tell whether anything in it may change."""
        return any(p.requires_grad for p in self.parameters())

    def forward(self, taps: Mapping[str, Tensor], pyramid: Sequence[Tensor]) -> Tensor:
        """Map taps and levels, finest first, to logits (n, 4, h / 4, w / 4)."""
        parts = [level(x) for level, x in zip(self.levels, pyramid, strict=True)]
        for k, (name, tap) in enumerate(zip(TAPPED, self.taps, strict=True), start=1):
            parts[k] = parts[k] + tap(taps[name])
        x = parts[1] + sum(_resized(part, parts[1]) for part in parts[2:])
        return self.top(_resized(self.middle(x), parts[0]) + parts[0])


def probabilities(logits: Tensor) -> Tensor:
    """Turn logits (n, 4, h, w) into probabilities: three that sum to 1, and ends."""
    kinds = functional.softmax(logits[:, :KINDS], 1)
    return torch.cat([kinds, torch.sigmoid(logits[:, KINDS:])], 1)


def losses(logits: Tensor, truth: Tensor) -> dict[str, Tensor]:
    """Compare logits with shares of cells, as `segmentation_data.cells` gives them.

    Cross entropy of the three kinds, each cell weighing what of it is no far row, and
    of the ends, which are rare and weigh more.
    """
    shares, ends, seen = truth[:, :KINDS], truth[:, KINDS], truth[:, KINDS + 1]
    likely = functional.log_softmax(logits[:, :KINDS], 1)
    entropy = -(shares * likely).sum() / shares.sum().clamp(min=1.0)
    each = functional.binary_cross_entropy_with_logits(
        logits[:, KINDS], ends, pos_weight=logits.new_tensor(RARE), reduction="none"
    )
    mean = (each * seen).sum() / seen.sum().clamp(min=1.0)
    return {"loss_kinds": entropy, "loss_ends": ENDS * mean}


def from_trial(weights: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Rename the first trial's weights; what it had not is left as a branch begins."""
    named = {k: v.numpy() for k, v in SemanticBranch().state_dict().items()}
    for name, array in weights.items():
        renamed = TRIAL[name[:2]] + name[2:]
        named[renamed] = array.reshape(named[renamed].shape)
    return named


def _layer(channels: int) -> nn.Sequential:
    return nn.Sequential(
        nn.Conv2d(channels, WIDTH, 3, padding=1), GroupNorm(WIDTH), nn.ReLU()
    )


def _silent(channels: int) -> nn.Sequential:
    last = nn.Conv2d(channels, WIDTH, 1, bias=False)
    nn.init.zeros_(last.weight)
    return nn.Sequential(GroupNorm(channels), last)


def _resized(x: Tensor, like: Tensor) -> Tensor:
    return functional.interpolate(
        x, size=like.shape[-2:], mode="bilinear", align_corners=False
    )
