"""One training of the inpainter: what changes from step to step, and how."""

from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import onnx
import torch
import torch.nn.functional as F  # noqa: N812 - everybody's name for it
from torch import Tensor

from export.inpainter import Critic, Generator
from export.inpainting_samples import Sample, tensors
from export.weights import GENERATOR, read_weights


@dataclass(frozen=True, slots=True)
class Recipe:
    """How to train; the paper's own values stand beside ours in the model card."""

    seed: int = 0
    width: int = 20
    stride: int = 2
    crop: int = 96  # px; the paper: 400 x 600
    batch: int = 6  # the paper: 8
    rate: float = 4e-4  # Adam; the paper: 2e-5 over millions of steps
    clip: float = 1.0  # of the gradient's norm; the paper's value
    fronts: float = 0.6  # share of samples that are fronts of the time
    painted: float = 0.1  # share that are painted fronts; the rest are other facades
    critic_from: int = 10**9  # the step at which SN-PatchGAN joins
    critic_weight: float = 0.01


def off_by(made: Tensor, image: Tensor, scored: Tensor) -> Tensor:
    """Mean absolute difference over the texels that are scored."""
    return ((made - image).abs() * scored).sum() / scored.sum().clamp(min=1)


class Trainer:
    """Both networks and their optimisers, which belong together."""

    def __init__(self, recipe: Recipe, *, device: str = "cpu") -> None:
        """Start anew from the recipe's seed."""
        torch.manual_seed(recipe.seed)
        self.recipe = recipe
        self.device = torch.device(device)
        generator = Generator(width=recipe.width, stride=recipe.stride)
        self.generator = generator.to(self.device)
        self.critic = Critic().to(self.device)
        self.averaged = {k: v.clone() for k, v in self.generator.state_dict().items()}
        self.for_generator = torch.optim.Adam(
            self.generator.parameters(), lr=recipe.rate, betas=(0.5, 0.99)
        )
        self.for_critic = torch.optim.Adam(
            self.critic.parameters(), lr=4e-4, betas=(0.0, 0.9)
        )
        self.step = 0

    def state(self) -> dict:
        """Give all that a resumed training needs."""
        return {
            "step": self.step,
            "recipe": asdict(self.recipe),
            "generator": self.generator.state_dict(),
            "averaged": self.averaged,
            "critic": self.critic.state_dict(),
            "for_generator": self.for_generator.state_dict(),
            "for_critic": self.for_critic.state_dict(),
        }

    def restore(self, state: dict) -> None:
        """Go on where another training stopped."""
        self.step = state["step"]
        self.generator.load_state_dict(state["generator"])
        self.averaged = {k: v.clone() for k, v in state["averaged"].items()}
        self.critic.load_state_dict(state["critic"])
        self.for_generator.load_state_dict(state["for_generator"])
        self.for_critic.load_state_dict(state["for_critic"])

    def start_from(self, model: Path) -> None:
        """Go on from a shipped file: its weights and steps; the rest starts anew."""
        named = read_weights(model)
        weights = {
            name.removeprefix(GENERATOR): torch.from_numpy(array.astype(np.float32))
            for name, array in named.items()
        }
        self.generator.load_state_dict(weights)
        self.averaged = {k: v.to(self.device).clone() for k, v in weights.items()}
        facts = {one.key: one.value for one in onnx.load(str(model)).metadata_props}
        self.step = int(facts["steps"])  # so that no sample is seen again

    def advance(self, samples: list[Sample]) -> dict[str, float]:
        """Take one step on one batch."""
        recipe = self.recipe
        image, hole, guesses, scored = (t.to(self.device) for t in tensors(samples))
        for group in self.for_generator.param_groups:
            group["lr"] = recipe.rate * min(1.0, (self.step + 1) / 50)
        with self.mixed():
            coarse, fine = (
                made.float() for made in self.generator(image, hole, guesses)
            )
        losses = {
            "coarse": off_by(coarse, image, scored),
            "fine": off_by(fine, image, scored),
        }
        total = losses["fine"] + 0.5 * losses["coarse"]
        if self.step >= recipe.critic_from:
            # The critic never sees what was not photographed: unknown texels are
            # those of the fill in the true picture as well.
            true = image * scored + fine.detach() * (1 - scored)
            true = torch.where(hole > 0, true, image)
            losses["critic"] = self._judge(true, fine.detach(), hole)
            self.critic.requires_grad_(requires_grad=False)
            losses["fooled"] = -self.critic(fine, hole).mean()
            self.critic.requires_grad_(requires_grad=True)
            total = total + recipe.critic_weight * losses["fooled"]
        self.for_generator.zero_grad(set_to_none=True)
        total.backward()
        torch.nn.utils.clip_grad_norm_(self.generator.parameters(), recipe.clip)
        self.for_generator.step()
        self.step += 1
        keep = min(0.995, self.step / (self.step + 20))
        for name, value in self.generator.state_dict().items():
            self.averaged[name].lerp_(value, 1 - keep)
        return {name: float(loss.detach()) for name, loss in losses.items()}

    def mixed(self) -> torch.autocast:
        """Reckon in bfloat16 on a GPU, where it is safe; on a CPU, in float32."""
        gpu = self.device.type == "cuda"
        return torch.autocast(self.device.type, dtype=torch.bfloat16, enabled=gpu)

    def _judge(self, true: Tensor, made: Tensor, hole: Tensor) -> Tensor:
        """Teach the critic, with the hinge loss (free-form paper, equation 3)."""
        loss = (
            F.relu(1 - self.critic(true, hole)).mean()
            + F.relu(1 + self.critic(made, hole)).mean()
        )
        self.for_critic.zero_grad(set_to_none=True)
        loss.backward()
        self.for_critic.step()
        return loss

    def smoothed(self) -> Generator:
        """Give the generator with its weights averaged over the last steps."""
        generator = Generator(width=self.recipe.width, stride=self.recipe.stride)
        generator.load_state_dict(self.averaged)
        return generator.eval()
