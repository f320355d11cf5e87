"""Training goes on from given weights, step by step, and can be cut off at any step.

Everything random in step i is seeded from (seed, i), so that a run that was cut off
and resumed from its last checkpoint ends with the same weights as one that was not.
What is kept is an exponential moving average of the weights.

    python -m export.train_mask_rcnn --data DATA --start START --into FOLDER
"""

import argparse
import json
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn
from torch.nn import functional

from export.ahead import ahead
from export.copy_paste import donors
from export.held_out import as_callable, figures, pixel_figures, pixels_alone
from export.mask_rcnn import MaskRCNN, freeze, load_weights
from export.painted_segmentation_data import read_painted
from export.pseudo_labels import read_pseudo
from export.rare import KINDS
from export.segmentation_data import Sample, read_folder, some
from export.segmentation_samples import Schedule, Seen, drawn
from export.semantic_branch import from_trial
from export.weights import BRANCH, read_weights
from nostalgin_core.segment import CATEGORIES

SETS = ("taxphotos", "historic_streets")


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


def begin(
    weights: dict[str, np.ndarray], schedule: Schedule, *, device: str = "cpu"
) -> Run:
    """Set up a run from weights; optimiser and average start anew."""
    torch.manual_seed(schedule.seed)
    network = load_weights(MaskRCNN(), weights).to(device)
    freeze(network, but_branch=schedule.branch_only, but_boxes=schedule.boxes_only)
    forgetful(network, schedule.dropout)
    learning = [p for p in network.parameters() if p.requires_grad]
    optimiser = torch.optim.AdamW(learning, lr=schedule.rate, weight_decay=1e-3)
    average = {k: v.detach().clone() for k, v in network.state_dict().items()}
    return Run(network, average, optimiser)


def forgetful(network: MaskRCNN, share: float) -> None:
    """Let a share of what boxes are told apart by be lost in training.

    Srivastava et al., "Dropout", JMLR 2014. It is a hook on the box head, so that
    weights keep their names and a network that is asked loses nothing. Raises
    ValueError unless 0 <= share < 1.
    """
    if not 0 <= share < 1:
        raise ValueError(f"dropout is a share below 1, not {share}")

    def lost(head: nn.Module, _: object, told: Tensor) -> Tensor:
        return functional.dropout(told, share, training=head.training)

    if share > 0:
        network.roi_heads.box_head.register_forward_hook(lost)


def advance(run: Run, schedule: Schedule, seen: Sequence[Seen]) -> dict[str, float]:
    """Take one step on what `drawn` gave for it, and return its mean losses."""
    torch.manual_seed(schedule.seed * 1_000_003 + run.step)
    run.network.train()
    run.optimiser.zero_grad(set_to_none=True)
    sums: dict[str, float] = {}
    ask = run.network.branch_losses if schedule.branch_only else run.network
    for one in seen:
        losses = ask(*one.tensors(run.device))
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


def started(args: argparse.Namespace, schedule: Schedule) -> Run:
    """Resume a run, or begin one; a start without a branch may be given one."""
    checkpoint = args.into / "last.pt"
    if checkpoint.exists():
        return resume(checkpoint, schedule, device=args.device)
    weights = read_weights(args.start)
    if args.branch:
        trial = from_trial(dict(np.load(args.branch)))
        weights |= {BRANCH + name: array for name, array in trial.items()}
    return begin(weights, schedule, device=args.device)


def pooled(args: argparse.Namespace) -> tuple[list[list[Sample]], list[Sample]]:
    """Return the pools that samples are drawn from, and the real photos among them.

    Each pool is drawn evenly: two tax photos and three of streets to one that is
    painted and two that nobody outlined.
    """
    tax, streets = (some(read_folder(args.data / n), args.share) for n in SETS)
    painted = read_painted(args.painted) if args.painted else []
    pseudo = []
    if args.pseudo:
        pseudo = read_pseudo(args.data / "historic_streets/photos", args.pseudo)
    pools = [tax] * 2 + [streets] * 3 + [painted] + [pseudo] * 2
    return [pool for pool in pools if pool], tax + streets


def judge(run: Run, data: Path, schedule: Schedule) -> dict[str, dict[str, float]]:
    """Measure what has been learnt on the photos kept out of either set."""
    network, rows = averaged(run), {}
    for name in SETS:
        samples = read_folder(data / name, held_out=True)
        if not schedule.branch_only:
            rows[name] = figures(as_callable(network), samples)
        if not schedule.boxes_only:
            rows[f"{name} pixels"] = pixel_figures(pixels_alone(network), samples)
    return rows


def planned(args: argparse.Namespace) -> Schedule:
    """Return the schedule that was asked for."""
    return Schedule(
        steps=args.steps,
        rate=args.rate,
        batch=args.batch,
        short_px=tuple(args.short_px),
        seed=args.seed,
        answering=tuple(args.answering),
        branch_only=args.branch_only,
        boxes_only=args.boxes_only,
        dropout=args.dropout,
        rare=args.rare,
        kinds=tuple(args.kinds),
    )


def main() -> None:
    """Train, log, measure on what is kept out, and keep checkpoints."""
    args = _arguments()
    torch.set_num_threads(args.threads)
    schedule = planned(args)
    pools, real = pooled(args)
    cut = donors(real)
    args.into.mkdir(parents=True, exist_ok=True)
    run = started(args, schedule)

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
                save(run, args.into / "last.pt")
            if run.step % args.judge_every == 0:
                row["held_out"] = judge(run, args.data, schedule)
                save(run, args.into / f"step{run.step:05d}.pt")
            log.write(json.dumps(row) + "\n")
            log.flush()
    save(run, args.into / "last.pt")


def _arguments(given: Sequence[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    usual = Schedule()
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--start", type=Path, required=True, help=".npz or .onnx")
    parser.add_argument("--branch", type=Path, help="trial's .npz, if start has none")
    alone = parser.add_mutually_exclusive_group()
    alone.add_argument("--branch-only", action="store_true", help="hold all else")
    alone.add_argument("--boxes-only", action="store_true", help="hold all else")
    parser.add_argument("--dropout", type=float, default=usual.dropout, help="of boxes")
    parser.add_argument(
        "--rare", type=float, default=usual.rare, help="share of photos"
    )
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=usual.kinds)
    parser.add_argument("--short-px", type=int, nargs=2, default=usual.short_px)
    parser.add_argument("--share", type=float, default=1.0, help="of the labels")
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
    return parser.parse_args(given)


if __name__ == "__main__":
    main()
