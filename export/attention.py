"""Contextual attention: a hole's features are copied from the patches most like them.

Yu et al., "Generative Image Inpainting with Contextual Attention", section 4.1, on
features at a quarter of the image's size. Foreground positions and background patches
live on a grid of half that again. With stride s only every s-th background patch is
offered along each axis, which divides the score map by s * s; the paper takes s = 2.

*Fuse* makes neighbours agree: a position that moves s cells should be copied from a
patch one further on. It is written as shifted sums along x and y, which is what the
identity kernel of the public code comes to, and works at any stride.

The score map of fh * fw positions by k patches is the memory of the whole network, so
it can be reckoned in horizontal strips of foreground, one after the other.

Only slices, products and sums are used, so that an export keeps its dynamic size.
"""

import torch
import torch.nn.functional as F  # noqa: N812 - everybody's name for it
from torch import Tensor, nn

TINY = 1e-20  # a weight below this is none


def patches(x: Tensor, *, size: int, stride: int) -> Tensor:
    """Cut centred patches: (b, c, h, w) -> (b, c * size * size, rows, columns).

    Odd sizes have a centre; even ones begin half a stride before their cell, so that
    patches of 4 at stride 2 hold their cell of 2 in the middle.
    """
    before = (size - 1) // 2
    height, width = x.shape[2], x.shape[3]
    padded = F.pad(x, (before, size - 1 - before) * 2)
    cut = [
        padded[:, :, dy : dy + height : stride, dx : dx + width : stride]
        for dy in range(size)
        for dx in range(size)
    ]
    return torch.stack(cut, 2).flatten(1, 2)


def paste(x: Tensor) -> Tensor:
    """Lay patches of 4 over one another at stride 2: the inverse of cutting them.

    (b, c * 16, h, w) -> (b, c, 2 h, 2 w). Each texel is the mean of the four patches
    that hold it; at the border, where fewer do, it is darker, as in the public code.
    """
    height, width = x.shape[2], x.shape[3]
    cells = x.unflatten(1, (-1, 4, 4))  # (b, c, 4, 4, h, w)
    total = 0
    for row in (0, 1):
        for column in (0, 1):
            part = cells[:, :, 2 * row : 2 * row + 2, 2 * column : 2 * column + 2]
            whole = F.pixel_shuffle(part.flatten(1, 3), 2)
            # A patch begins one texel before its cell.
            padded = F.pad(whole, (2 * column, 2 - 2 * column, 2 * row, 2 - 2 * row))
            total = total + padded
    return total[:, :, 1 : 2 * height + 1, 1 : 2 * width + 1] / 4


def agree(scores: Tensor, *, stride: int) -> Tensor:
    """Add to each score those of its neighbours, along x, then along y.

    scores: (b, fh, fw, kh, kw); foreground moves by `stride`, background by one.
    """
    for foreground, background in ((2, 4), (1, 3)):
        n, k = scores.shape[foreground], scores.shape[background]
        # F.pad counts axes from the last one, two numbers each.
        border = [0] * 10
        border[8 - 2 * foreground : 10 - 2 * foreground] = [stride, stride]
        border[8 - 2 * background : 10 - 2 * background] = [1, 1]
        padded = F.pad(scores, border)
        parts = []
        for shift in (0, 1, 2):
            window = [slice(None)] * 5
            window[foreground] = slice(shift * stride, shift * stride + n)
            window[background] = slice(shift, shift + k)
            parts.append(padded[tuple(window)])
        scores = parts[0] + parts[1] + parts[2]
    return scores


def decide(scores: Tensor, offered: Tensor) -> Tensor:
    """Share one out among the patches offered, by their scores, the last axis.

    A decided softmax is full of denormal numbers, and products with those would cost a
    CPU more than all the rest of the network: they are made zero.
    """
    weights = torch.softmax(scores - 1e4 * (1 - offered), dim=-1)
    return F.relu(weights - TINY) * offered


class Attention(nn.Module):
    """Copy known features into the hole; where nothing is known, answer zero."""

    def __init__(self, *, stride: int = 2, sharpness: float = 10.0) -> None:
        """Set the background's stride and how decided the choice is."""
        super().__init__()
        self.stride = stride
        self.sharpness = sharpness

    def forward(self, x: Tensor, hole: Tensor, *, strips: int = 1) -> Tensor:
        """Rebuild every feature from the known patches most like it.

        Args:
            x: (b, c, h, w), h and w even.
            hole: (b, 1, h, w), above 0 where unknown.
            strips: how many pieces the foreground is cut into.
        """
        small = x[:, :, ::2, ::2]
        keys = patches(small, size=3, stride=self.stride)  # (b, 9c, kh, kw)
        keys = keys / keys.square().sum(1, keepdim=True).add(1e-4).sqrt()
        values = patches(x, size=4, stride=2 * self.stride).flatten(2)  # (b, 16c, k)
        spoiled = patches(F.max_pool2d(hole, 2), size=3, stride=self.stride)
        known = (spoiled.amax(1) < 0.5).to(x.dtype)  # (b, kh, kw)
        queries = patches(small, size=3, stride=1)  # (b, 9c, fh, fw)

        height, halo = small.shape[2], self.stride
        padded = F.pad(queries, (0, 0, halo, halo + strips))
        tall = (height + strips - 1) // strips
        made = []
        for strip in range(strips):
            top = tall * strip
            part = padded[:, :, top : top + tall + 2 * halo]
            made.append(self._strip(part, keys, values, known))
        rebuilt = torch.cat(made, 2) if strips > 1 else made[0]
        return paste(rebuilt[:, :, :height])

    def _strip(
        self, queries: Tensor, keys: Tensor, values: Tensor, known: Tensor
    ) -> Tensor:
        """Attend from some rows, given with `stride` rows more above and below."""
        height, width = queries.shape[2], queries.shape[3]
        scores = torch.matmul(queries.flatten(2).transpose(1, 2), keys.flatten(2))
        scores = scores.reshape(
            scores.shape[0], height, width, keys.shape[2], keys.shape[3]
        )
        scores = agree(scores, stride=self.stride)
        scores = scores[:, self.stride : height - self.stride].flatten(3).flatten(1, 2)
        offered = known.flatten(1)[:, None]  # (b, 1, k)
        weights = decide(scores * self.sharpness, offered)
        rebuilt = torch.matmul(values, weights.transpose(1, 2))  # (b, 16c, f)
        return rebuilt.reshape(
            rebuilt.shape[0], rebuilt.shape[1], height - 2 * self.stride, width
        )
