"""The inpainting network, whole: a two-stage gated generator and its critic.

The generator is that of free-form inpainting (Yu et al., "Free-Form Image Inpainting
with Gated Convolution"), gray, as the paper slims it (section 3.4 and the appendix): a
coarse stage, then a refinement stage with two branches, one of which copies known
features into the hole by contextual attention of stride 2.

Two things differ from it, and both buy quality for few training steps. The network is
handed a *guess*, a smooth fill of the hole, beside the photograph and the hole, and
each stage answers with what has to be added to it. And the first three kernels are
5, 3, 3 as in the free-form paper by default: the paper's 20, 10, 5 would cost more
than the rest of the network together.

*Width* counts filters before gating, so that a width of 20 leaves 10 features in the
first layer: one half of the filters gates the other. The public code calls it `cnum`.

Letters: b batch, c channels, h w size, s the attention's stride.
"""

from itertools import pairwise

import torch
import torch.nn.functional as F  # noqa: N812 - everybody's name for it
from jaxtyping import Float
from torch import Tensor, nn

from export.attention import Attention

Image = Float[Tensor, "b 1 h w"]  # -1 to 1

MULTIPLE = 8  # height and width must be multiples of this


class Gated(nn.Module):
    """A convolution whose one half of filters decides how much of the other passes.

    elu(f) * sigmoid(g), f and g being the two halves (free-form paper, equation 2).
    """

    def __init__(
        self, inner: int, outer: int, *, kernel: int = 3, stride: int = 1, rate: int = 1
    ) -> None:
        """Make `2 * outer` filters, of which `outer` are gates."""
        super().__init__()
        padding = rate * (kernel - 1) // 2
        self.conv = nn.Conv2d(inner, 2 * outer, kernel, stride, padding, rate)
        nn.init.orthogonal_(self.conv.weight, gain=1.3)
        nn.init.zeros_(self.conv.get_parameter("bias"))

    def forward(self, x: Tensor) -> Tensor:
        """Filter and gate."""
        features, gates = self.conv(x).chunk(2, dim=1)
        return F.elu(features) * torch.sigmoid(gates)


class Doubled(nn.Module):
    """A gated convolution at twice the size."""

    def __init__(self, inner: int, outer: int) -> None:
        """Enlarge first, filter then: no checkerboard."""
        super().__init__()
        self.gated = Gated(inner, outer)

    def forward(self, x: Tensor) -> Tensor:
        """Enlarge and filter."""
        return self.gated(F.interpolate(x, scale_factor=2.0, mode="nearest"))


def _down(width: int, kernels: tuple[int, int, int]) -> nn.Sequential:
    """From the image to 4 * width features at a quarter of its size."""
    first, second, third = kernels
    return nn.Sequential(
        Gated(3, width, kernel=first),
        Gated(width, 2 * width, kernel=second, stride=2),
        Gated(2 * width, 2 * width, kernel=third),
        Gated(2 * width, 4 * width, stride=2),
        Gated(4 * width, 4 * width),
        Gated(4 * width, 4 * width),
    )


def _wide(width: int) -> nn.Sequential:
    """Dilated layers, which look 16 features far without growing dearer."""
    return nn.Sequential(*(Gated(width, width, rate=rate) for rate in (2, 4, 8, 16)))


def _up(inner: int, width: int) -> nn.Sequential:
    """From features at a quarter of the size to what is to be added to the guess."""
    last = nn.Conv2d(max(width // 2, 4), 1, 3, padding=1)
    nn.init.normal_(last.weight, std=0.01)  # a fresh network answers with the guess
    nn.init.zeros_(last.get_parameter("bias"))
    return nn.Sequential(
        Gated(inner, 4 * width),
        Gated(4 * width, 4 * width),
        Doubled(4 * width, 2 * width),
        Gated(2 * width, 2 * width),
        Doubled(2 * width, width),
        Gated(width, max(width // 2, 4)),
        last,
    )


class Generator(nn.Module):
    """Fill a hole in a gray image, in two stages."""

    def __init__(
        self,
        *,
        width: int = 20,
        stride: int = 2,
        kernels: tuple[int, int, int] = (5, 3, 3),
    ) -> None:
        """Build both stages: width 20 and stride 2 are the paper's choice."""
        super().__init__()
        if any(kernel % 2 == 0 for kernel in kernels):
            raise ValueError(f"kernels must be odd to be centred, not {kernels}")
        kept = width // 2
        self.coarse = nn.Sequential(
            _down(kept, kernels), _wide(4 * kept), _up(4 * kept, kept)
        )
        self.refine = nn.Sequential(_down(kept, kernels), _wide(4 * kept))
        self.attend = _down(kept, kernels)
        self.attention = Attention(stride=stride)
        self.blend = nn.Sequential(Gated(4 * kept, 4 * kept), Gated(4 * kept, 4 * kept))
        self.finish = _up(8 * kept, kept)

    def forward(
        self, image: Image, hole: Image, guess: Image, *, strips: int = 1
    ) -> tuple[Image, Image]:
        """Answer with the coarse and the refined image, known pixels included.

        Args:
            image: the photograph; what it shows inside the hole is not looked at.
            hole: 1 where it is to be filled, else 0.
            guess: a smooth fill, equal to the image outside the hole.
            strips: how many pieces the attention is reckoned in; more need less memory.
        """
        known = image * (1 - hole)
        coarse = guess + self.coarse(torch.cat([known, hole, guess], 1))
        coarse = known + hole * coarse.clamp(-1.2, 1.2)
        stacked = torch.cat([coarse, hole, guess], 1)
        attended = self.attention(
            self.attend(stacked), F.max_pool2d(hole, 4), strips=strips
        )
        features = torch.cat([self.refine(stacked), self.blend(attended)], 1)
        fine = coarse + self.finish(features)
        return coarse, known + hole * fine.clamp(-1.2, 1.2)


class Critic(nn.Module):
    """SN-PatchGAN: judge every patch of an image, given where it was filled.

    Six convolutions of kernel 5 and stride 2 under spectral normalisation; each
    feature of the last is one judgement (free-form paper, section 3.3), and nothing
    bends it: a leaky last layer squeezes the verdict "made" to a fifth.
    """

    def __init__(self, *, width: int = 32) -> None:
        """Build the critic, with at most 4 * width channels."""
        super().__init__()
        channels = [2, width, 2 * width, 4 * width, 4 * width, 4 * width, 4 * width]
        self.layers = nn.ModuleList(
            nn.utils.parametrizations.spectral_norm(
                nn.Conv2d(inner, outer, 5, stride=2, padding=2)
            )
            for inner, outer in pairwise(channels)
        )

    def forward(self, image: Image, hole: Image) -> Tensor:
        """Score patches: high is photographed, low is made."""
        x = torch.cat([image, hole], 1)
        *inner, last = self.layers
        for layer in inner:
            x = F.leaky_relu(layer(x), 0.2)
        return last(x)
