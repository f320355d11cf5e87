"""Train the inpainter: seeded, resumable, with held-out figures on the way.

Every step draws its samples from a generator seeded by (seed, step), so a training
that was cut off and resumed sees exactly what an uninterrupted one would have seen.

    python -m export.train_inpainter DATA FOLDER --start MODEL.onnx --minutes 90

FOLDER receives `checkpoint.pt`, `best.pt`, `log.jsonl` and sample pictures.
"""

import argparse
import json
import time
from collections import Counter
from dataclasses import asdict
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import torch

from export.ahead import ahead
from export.inpainter_exam import answer, before, exam, marks, navier_stokes, picture
from export.inpainter_trainer import Recipe, Trainer
from export.inpainting_data import Kind, Sheet, sheets
from export.inpainting_samples import Sample, mixture
from export.masks import Outline, outlines

MOST_STEPS = 10**7  # minutes end a training long before


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


def begin(
    checkpoint: Path,
    given: dict[str, Any],
    *,
    device: str,
    start: Path | None = None,
) -> Trainer:
    """Go on from a checkpoint, its recipe changed by what is given, or start.

    Where there is no checkpoint, `start` is a shipped file to go on from; without one
    all starts anew.
    """
    if not checkpoint.exists():
        trainer = Trainer(Recipe(**given), device=device)
        if start is not None:
            trainer.start_from(start)
        return trainer
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
    parser.add_argument("--start", type=Path, help="shipped .onnx; none: anew")
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
    checkpoint, start = folder / "checkpoint.pt", options["start"]
    train(
        begin(checkpoint, given, device=options["device"], start=start),
        sheets(options["data"]),
        outlines(options["data"]),
        folder,
        minutes=options["minutes"],
        every=options["every"],
        workers=options["workers"],
    )


if __name__ == "__main__":
    main()
