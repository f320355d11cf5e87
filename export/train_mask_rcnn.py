"""Training goes on from given weights, step by step, and can be cut off at any step.

Everything random in step i is seeded from (seed, i), so that a run that was cut off
and resumed from its last checkpoint ends with the same weights as one that was not.
What is kept is an exponential moving average of the weights.

    python -m export.train_mask_rcnn --data DATA --start START --into FOLDER
"""

import argparse
import json
import math
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from export.ahead import ahead
from export.blemishes import blemished
from export.copy_paste import Donor, donors, paste
from export.held_out import as_callable, figures
from export.mask_rcnn import MaskRCNN, freeze, load_weights
from export.painted_segmentation_data import read_painted
from export.pseudo_labels import read_pseudo
from export.segmentation_data import (
    UNSCORED,
    Sample,
    Truth,
    read_folder,
    tilted,
    truth,
    view,
)
from export.wear import wear
from export.weights import read_weights
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

    def rate_at(self, step: int) -> float:
        """Return the learning rate of a step."""
        rise = min(1.0, (step + 1) / self.warm_up)
        fall = 0.5 * (1 + math.cos(math.pi * min(1.0, step / self.steps)))
        return self.rate * rise * (0.01 + 0.99 * fall)


@dataclass(slots=True)
class Run:
    """A network on its way: the one thing here that changes."""

    network: MaskRCNN
    average: dict[str, Tensor]
    optimiser: torch.optim.Optimizer
    step: int = 0

    @property
    def device(self) -> torch.device:
        """Tell where the network is."""
        return next(self.network.parameters()).device


@dataclass(frozen=True, slots=True, eq=False)
class Seen:
    """One photo as the network is shown it, and what it should answer."""

    image: Gray
    answer: Truth

    def tensors(self, device: torch.device) -> tuple[Tensor, list[dict[str, Tensor]]]:
        """Give both to torch."""
        gray = torch.from_numpy(self.image.astype(np.float32))[None, None]
        target = {
            "boxes": torch.from_numpy(self.answer.boxes).to(device),
            "labels": torch.from_numpy(self.answer.labels).to(device),
            "masks": torch.from_numpy(self.answer.masks.astype(np.uint8)).to(device),
        }
        return gray.to(device, memory_format=torch.channels_last), [target]


def begin(
    weights: dict[str, np.ndarray], schedule: Schedule, *, device: str = "cpu"
) -> Run:
    """Set up a run from weights; optimiser and average start anew."""
    torch.manual_seed(schedule.seed)
    network = load_weights(MaskRCNN(), weights).to(device)
    freeze(network)
    learning = [p for p in network.parameters() if p.requires_grad]
    optimiser = torch.optim.AdamW(learning, lr=schedule.rate, weight_decay=1e-3)
    average = {k: v.detach().clone() for k, v in network.state_dict().items()}
    return Run(network, average, optimiser)


def advance(run: Run, schedule: Schedule, seen: Sequence[Seen]) -> dict[str, float]:
    """Take one step on what `drawn` gave for it, and return its mean losses."""
    torch.manual_seed(schedule.seed * 1_000_003 + run.step)
    run.network.train()
    run.optimiser.zero_grad(set_to_none=True)
    sums: dict[str, float] = {}
    for one in seen:
        losses = run.network(*one.tensors(run.device))
        torch.stack(list(losses.values())).sum().div(len(seen)).backward()
        for name, loss in losses.items():
            sums[name] = sums.get(name, 0.0) + loss.item() / len(seen)
    learning = [p for p in run.network.parameters() if p.requires_grad]
    torch.nn.utils.clip_grad_norm_(learning, schedule.clip)
    for group in run.optimiser.param_groups:
        group["lr"] = schedule.rate_at(run.step)
    run.optimiser.step()
    run.step += 1
    _average(run, schedule)
    return sums


@torch.no_grad()
def _average(run: Run, schedule: Schedule) -> None:
    # A young average must not cling to where it started from.
    decay = min(schedule.decay, (1 + run.step) / (10 + run.step))
    for name, value in run.network.state_dict().items():
        run.average[name].lerp_(value, 1 - decay)


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
        if rng.random() < 0.5:
            sample = paste(sample, cut, rng)
        sample = blemished(sample, rng)
        answer = truth(sample)
        if np.isin(answer.labels, wanted).any():
            break
    kept = np.isin(answer.labels, [*wanted, UNSCORED])
    parts = answer.boxes[kept], answer.labels[kept], answer.masks[kept]
    return Seen(wear(sample.image, rng), Truth(*parts))


def save(run: Run, path: Path) -> None:
    """Write a checkpoint so that a reader sees a whole one or none."""
    parts = {
        "network": run.network.state_dict(),
        "average": run.average,
        "optimiser": run.optimiser.state_dict(),
        "step": run.step,
    }
    torch.save(parts, path.with_suffix(".tmp"))
    path.with_suffix(".tmp").replace(path)


def resume(path: Path, schedule: Schedule, *, device: str = "cpu") -> Run:
    """Go on from a checkpoint, exactly."""
    parts = torch.load(path, weights_only=True, map_location=device)
    weights = {k: v.cpu().numpy() for k, v in parts["network"].items()}
    run = begin(weights, schedule, device=device)
    run.optimiser.load_state_dict(parts["optimiser"])
    return Run(run.network, parts["average"], run.optimiser, parts["step"])


def averaged(run: Run) -> MaskRCNN:
    """Return the network with its averaged weights, ready to be asked."""
    weights = {k: v.cpu().numpy() for k, v in run.average.items()}
    return load_weights(MaskRCNN(), weights).eval()


def main() -> None:
    """Train, log, measure on the held-out block, and keep checkpoints."""
    args = _arguments()
    torch.set_num_threads(args.threads)
    schedule = Schedule(
        steps=args.steps,
        rate=args.rate,
        batch=args.batch,
        seed=args.seed,
        answering=tuple(args.answering),
    )
    real = [read_folder(args.data / n) for n in ("taxphotos", "historic_streets")]
    painted = read_painted(args.painted) if args.painted else []
    pseudo = []
    if args.pseudo:
        pseudo = read_pseudo(args.data / "historic_streets/photos", args.pseudo)
    # Each pool is drawn evenly: two real photos of either set to one that is painted
    # and two that nobody outlined.
    pools = [p for p in (*real, *real, painted, pseudo, pseudo) if p]
    judged = read_folder(args.data / "taxphotos", held_out=True)
    cut = donors([s for pool in real for s in pool])
    args.into.mkdir(parents=True, exist_ok=True)
    checkpoint = args.into / "last.pt"
    if checkpoint.exists():
        run = resume(checkpoint, schedule, device=args.device)
    else:
        run = begin(read_weights(args.start), schedule, device=args.device)

    def draw(step: int) -> list[Seen]:
        return drawn(pools, cut, step, schedule)

    shown = ahead(draw, run.step, schedule.steps, workers=args.workers)
    with (args.into / "log.jsonl").open("a") as log:
        since = time.monotonic()
        for seen in shown:
            losses = advance(run, schedule, seen)
            row: dict[str, object] = {"step": run.step, **losses}
            row["seconds"] = round(time.monotonic() - since, 1)
            if run.step % args.save_every == 0:
                save(run, checkpoint)
            if run.step % args.judge_every == 0:
                row["held_out"] = figures(as_callable(averaged(run)), judged)
                save(run, args.into / f"step{run.step:05d}.pt")
            log.write(json.dumps(row) + "\n")
            log.flush()
    save(run, checkpoint)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    usual = Schedule()
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--start", type=Path, required=True, help=".npz or .onnx")
    parser.add_argument("--into", type=Path, required=True, help="logs, checkpoints")
    parser.add_argument("--painted", type=Path, help="folder of painted photos")
    parser.add_argument("--pseudo", type=Path, help="folder of pseudo labels")
    parser.add_argument("--steps", type=int, default=usual.steps)
    parser.add_argument("--rate", type=float, default=usual.rate)
    parser.add_argument(
        "--answering", nargs="+", choices=CATEGORIES, default=usual.answering
    )
    parser.add_argument("--seed", type=int, default=usual.seed)
    parser.add_argument("--batch", type=int, default=usual.batch)
    parser.add_argument("--device", default="cpu", help="cpu or cuda")
    parser.add_argument("--workers", type=int, default=0, help="that draw photos")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--save-every", type=int, default=50)
    parser.add_argument("--judge-every", type=int, default=250)
    return parser.parse_args()


if __name__ == "__main__":
    main()
