"""Train the inpainter: seeded, resumable, with held-out figures on the way.

Every step draws its samples from a generator seeded by (seed, step), so a training
that was cut off and resumed sees exactly what an uninterrupted one would have seen.

    python -m export.train_inpainter DATA FOLDER --minutes 90

FOLDER receives `checkpoint.pt`, `best.pt`, `log.jsonl` and sample pictures.
"""

import argparse
import json
import time
from collections import Counter
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import torch
import torch.nn.functional as F  # noqa: N812 - everybody's name for it
from torch import Tensor

from export.ahead import ahead
from export.inpainter import Critic, Generator
from export.inpainter_exam import answer, before, exam, marks, navier_stokes, picture
from export.inpainting_data import Kind, Sheet, sheets
from export.inpainting_samples import Sample, mixture, tensors
from export.masks import Outline, outlines

MOST_STEPS = 10**7  # minutes end a training long before


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


def batch(
    recipe: Recipe,
    step: int,
    pictures: tuple[Sheet, ...],
    silhouettes: tuple[Outline, ...],
) -> list[Sample]:
    """Draw the samples of one step as the recipe has them."""
    shares: dict[Kind, float] = {
        "front": recipe.fronts,
        "painted": recipe.painted,
        "plain": 1 - recipe.fronts - recipe.painted,
    }
    return mixture(
        (recipe.seed, step),
        pictures,
        silhouettes,
        shares=shares,
        count=recipe.batch,
        crop=recipe.crop,
    )


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


def save(state: dict, path: Path) -> None:
    """Write a checkpoint so that a cut-off never leaves half of one."""
    partial = path.with_suffix(".partial")
    torch.save(state, partial)
    partial.replace(path)


class Diary:
    """Writes every line of a training's log to a file, and shows it."""

    def __init__(self, path: Path) -> None:
        """Go on at the end of a file."""
        self.path = path

    def note(self, step: int, **values: float | str) -> None:
        """Write one line."""
        line = json.dumps({"step": step, **values})
        print(line, flush=True)
        with self.path.open("a") as log:
            print(line, file=log)


def begin(checkpoint: Path, given: dict[str, Any], *, device: str) -> Trainer:
    """Go on from a checkpoint, its recipe changed by what is given, or start anew."""
    if not checkpoint.exists():
        return Trainer(Recipe(**given), device=device)
    state = torch.load(checkpoint, weights_only=True, map_location=device)
    trainer = Trainer(Recipe(**(state["recipe"] | given)), device=device)
    trainer.restore(state)
    return trainer


def train(
    trainer: Trainer,
    pictures: tuple[Sheet, ...],
    silhouettes: tuple[Outline, ...],
    folder: Path,
    *,
    minutes: float,
    every: int,
    workers: int = 0,
) -> None:
    """Take steps until the minutes are over; examine and save every so many."""
    diary, questions = Diary(folder / "log.jsonl"), exam(pictures)
    taught = tuple(p for p in pictures if not p.held_out)
    for name, method in (("navier-stokes", navier_stokes), ("guess", before)):
        l1, l2 = marks([method(q) for q in questions], questions)
        diary.note(trainer.step, exam=name, l1=l1, l2=l2)
    counts = Counter(p.kind for p in taught)
    diary.note(trainer.step, taught=len(taught), **counts)
    until = time.monotonic() + 60 * minutes
    recent: list[dict[str, float]] = []

    def draw(step: int) -> list[Sample]:
        return batch(trainer.recipe, step, taught, silhouettes)

    for drawn in ahead(draw, trainer.step, MOST_STEPS, workers=workers):
        recent.append(trainer.advance(drawn))
        if trainer.step % 50 == 0:
            names = recent[-1]
            means = {k: float(np.mean([r[k] for r in recent if k in r])) for k in names}
            diary.note(trainer.step, **means, cpu_s=time.process_time())
            recent = []
        if trainer.step % every == 0:
            save(trainer.state(), folder / "checkpoint.pt")
            made = [answer(trainer.smoothed(), q) for q in questions]
            l1, l2 = marks(made, questions)
            diary.note(trainer.step, exam="ours", l1=l1, l2=l2)
            sheet = picture(made[::3], questions[::3])
            cv2.imwrite(str(folder / f"sample_{trainer.step:06d}.png"), sheet)
        if time.monotonic() > until:
            break
    save(trainer.state(), folder / "checkpoint.pt")


def main() -> None:
    """Train until the minutes are over, going on from the folder's checkpoint."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--minutes", type=float, default=60)
    parser.add_argument("--every", type=int, default=200, help="steps between exams")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--device", default="cpu", help="cpu or cuda")
    parser.add_argument("--workers", type=int, default=0, help="that draw samples")
    for name, value in asdict(Recipe()).items():
        parser.add_argument(f"--{name.replace('_', '-')}", type=type(value))
    options = vars(parser.parse_args())
    torch.set_num_threads(options["threads"])
    given = {k: options[k] for k in asdict(Recipe()) if options[k] is not None}
    folder: Path = options["folder"]
    folder.mkdir(parents=True, exist_ok=True)
    train(
        begin(folder / "checkpoint.pt", given, device=options["device"]),
        sheets(options["data"]),
        outlines(options["data"]),
        folder,
        minutes=options["minutes"],
        every=options["every"],
        workers=options["workers"],
    )


if __name__ == "__main__":
    main()
