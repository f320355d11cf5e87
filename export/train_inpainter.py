"""Train the inpainter: seeded, resumable, with held-out figures on the way.

Every step draws its samples from a generator seeded by (seed, step), so a training
that was cut off and resumed sees exactly what an uninterrupted one would have seen.

    python -m export.train_inpainter DATA FOLDER --minutes 90

FOLDER receives `checkpoint.pt`, `best.pt`, `log.jsonl` and sample pictures.
"""

import argparse
import json
import time
from dataclasses import asdict, dataclass
from pathlib import Path

import cv2
import numpy as np
import torch
import torch.nn.functional as F  # noqa: N812 - everybody's name for it
from torch import Tensor

from export.inpainter import Critic, Generator
from export.inpainting_data import Sheet, sheets
from export.masks import Outline, outlines, standing
from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.free_form import free_form_share
from nostalgin_core.repetition import guess


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
    critic_from: int = 10**9  # the step at which SN-PatchGAN joins
    critic_weight: float = 0.01


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
    at_foot = rng.random() < 0.35
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


def off_by(made: Tensor, image: Tensor, scored: Tensor) -> Tensor:
    """Mean absolute difference over the texels that are scored."""
    return ((made - image).abs() * scored).sum() / scored.sum().clamp(min=1)


class Trainer:
    """Both networks and their optimisers, which belong together."""

    def __init__(self, recipe: Recipe) -> None:
        """Start anew from the recipe's seed."""
        torch.manual_seed(recipe.seed)
        self.recipe = recipe
        self.generator = Generator(width=recipe.width, stride=recipe.stride)
        self.critic = Critic()
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
        image, hole, guesses, scored = tensors(samples)
        for group in self.for_generator.param_groups:
            group["lr"] = recipe.rate * min(1.0, (self.step + 1) / 50)
        coarse, fine = self.generator(image, hole, guesses)
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


def batch(
    recipe: Recipe,
    step: int,
    pictures: tuple[Sheet, ...],
    silhouettes: tuple[Outline, ...],
) -> list[Sample]:
    """Draw the samples of one step, the same ones every time."""
    rng = np.random.default_rng((recipe.seed, step))
    kinds = [
        tuple(p for p in pictures if p.front),
        tuple(p for p in pictures if not p.front),
    ]
    return [
        draw(
            kinds[int(rng.random() >= recipe.fronts)] or pictures,
            silhouettes,
            recipe.crop,
            rng=rng,
        )
        for _ in range(recipe.batch)
    ]


def exam(pictures: tuple[Sheet, ...], *, count: int = 24) -> list[Sample]:
    """Set the held-out questions: fronts of the time at their own size, to 256 px.

    A half is of block 993. Holes are free-form, 20 to 30 % of the crop.
    """
    kept = [p for p in pictures if p.held_out and p.front]
    tuned = [p for p in kept if "/00993" in p.name]
    others = [p for p in kept if "/00993" not in p.name]
    rng = np.random.default_rng(993)
    questions = []
    for group in (tuned, others):
        for index in rng.permutation(len(group))[: count // 2]:
            sheet = group[index]
            h, w = (min(256, n // 8 * 8) for n in sheet.image.shape)
            y = rng.integers(sheet.image.shape[0] - h + 1)
            x = rng.integers(sheet.image.shape[1] - w + 1)
            image = np.ascontiguousarray(sheet.image[y : y + h, x : x + w])
            known = sheet.known[y : y + h, x : x + w]
            hole = free_form_share((h, w), least=rng.uniform(0.18, 0.25), rng=rng)
            if (hole & known).any() and (known & ~hole).any():
                made = guessed(image, hole | ~known)
                questions.append(Sample(image, hole | ~known, hole & known, made))
    return questions


def answer(generator: Generator, question: Sample) -> Gray:
    """Fill one held-out picture."""
    image, hole, guesses, _ = tensors([question])
    with torch.no_grad():
        made = generator(image, hole, guesses)[1][0, 0].numpy()
    return np.clip(np.round((made + 1) * 127.5), 0, 255).astype(np.uint8)


def navier_stokes(question: Sample) -> Gray:
    """Fill with the classical method that all figures are measured against."""
    return cv2.inpaint(
        question.image, question.hole.astype(np.uint8), 3, cv2.INPAINT_NS
    )


def before(question: Sample) -> Gray:
    """Give the guess that the network starts from."""
    return question.guess


def marks(made: list[Gray], questions: list[Sample]) -> tuple[float, float]:
    """Give l1 and l2 in percent, over the scored texels, mean over the pictures."""
    off = [
        (m.astype(float) - q.image)[q.scored] / 255
        for m, q in zip(made, questions, strict=True)
    ]
    return (
        100 * float(np.mean([np.abs(d).mean() for d in off])),
        100 * float(np.mean([np.square(d).mean() for d in off])),
    )


def picture(made: list[Gray], questions: list[Sample]) -> Gray:
    """Lay truth, hole, the classical fill and ours side by side, one row a picture."""
    rows = []
    for ours, question in zip(made, questions, strict=True):
        cut = np.where(question.hole, np.uint8(255), question.image)
        row = np.hstack([question.image, cut, navier_stokes(question), ours])
        rows.append(np.pad(row, ((0, 4), (0, 1024 - row.shape[1]))))
    return np.vstack(rows)


def save(state: dict, path: Path) -> None:
    """Write a checkpoint so that a cut-off never leaves half of one."""
    partial = path.with_suffix(".partial")
    torch.save(state, partial)
    partial.replace(path)


def main() -> None:
    """Train until the minutes are over, going on from the folder's checkpoint."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--minutes", type=float, default=60)
    parser.add_argument("--every", type=int, default=200, help="steps between exams")
    parser.add_argument("--threads", type=int, default=1)
    for name, value in asdict(Recipe()).items():
        parser.add_argument(f"--{name.replace('_', '-')}", type=type(value))
    options = vars(parser.parse_args())
    torch.set_num_threads(options["threads"])
    given = {k: options[k] for k in asdict(Recipe()) if options[k] is not None}
    folder: Path = options["folder"]
    folder.mkdir(parents=True, exist_ok=True)
    checkpoint = folder / "checkpoint.pt"
    state = torch.load(checkpoint, weights_only=True) if checkpoint.exists() else None
    trainer = Trainer(Recipe(**((state or {}).get("recipe", {}) | given)))
    if state:
        trainer.restore(state)
    pictures = sheets(options["data"])
    silhouettes = outlines(options["data"])
    taught = tuple(p for p in pictures if not p.held_out)
    questions = exam(pictures)
    with (folder / "log.jsonl").open("a") as log:

        def note(**values: float | str) -> None:
            """Write one line of the log, and show it."""
            line = json.dumps({"step": trainer.step, **values})
            print(line, flush=True)
            print(line, file=log, flush=True)

        for name, method in (("navier-stokes", navier_stokes), ("guess", before)):
            l1, l2 = marks([method(q) for q in questions], questions)
            note(exam=name, l1=l1, l2=l2)
        note(taught=len(taught), fronts=sum(p.front for p in taught))
        until = time.monotonic() + 60 * options["minutes"]
        recent: list[dict[str, float]] = []
        while time.monotonic() < until:
            samples = batch(trainer.recipe, trainer.step, taught, silhouettes)
            recent.append(trainer.advance(samples))
            if trainer.step % 50 == 0:
                means = {
                    k: float(np.mean([r[k] for r in recent if k in r]))
                    for k in recent[-1]
                }
                note(**means, cpu_s=time.process_time())
                recent = []
            if trainer.step % options["every"] == 0:
                save(trainer.state(), checkpoint)
                made = [answer(trainer.smoothed(), q) for q in questions]
                l1, l2 = marks(made, questions)
                note(exam="ours", l1=l1, l2=l2)
                sheet = picture(made[::3], questions[::3])
                cv2.imwrite(str(folder / f"sample_{trainer.step:06d}.png"), sheet)
        save(trainer.state(), checkpoint)


if __name__ == "__main__":
    main()
