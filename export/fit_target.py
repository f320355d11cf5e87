"""The seven weights of `nostalgin_core/matte/target.py` are fitted to hand labels.

Each labelled tax photo gives its fronts as the network finds them inside the film's
border, their sides made straight: as in a build, since what is stated of them is to
come true of them. A front
counts as recorded where what is visible of it overlaps a labelled target by a half or
more. The weights minimise the logistic loss, summed over fronts, plus a tenth of their
squares. What is stated of each photo by weights fitted to the others, in eight parts,
is held against the labels.

    python -m export.fit_target --data DATA --answers .train/answers
"""

import argparse
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float
from scipy.optimize import minimize

from export.remembered import shipped
from export.segmentation_data import Sample, fill, read_folder
from nostalgin_core import matte, placard, segment
from nostalgin_core.matte.target import WEIGHTS, Shown, features
from nostalgin_core.measure.calibration import Reliability, reliability
from nostalgin_core.measure.segmentation import overlap
from nostalgin_core.photo import framed
from nostalgin_core.records import Facade, Instance, Photo, Rejection
from nostalgin_core.segment import Network

Fronts = tuple[Float[np.ndarray, "n 7"], Bool[np.ndarray, " n"]]
RIDGE = 0.1
PARTS = 8


def fit(photos: Sequence[Fronts]) -> Float[np.ndarray, " 7"]:
    """Return the weights under which the recorded fronts are likeliest."""
    rows = np.vstack([one for one, _ in photos])
    recorded = np.concatenate([one for _, one in photos])

    def loss(weights: np.ndarray) -> float:
        total = np.logaddexp(0, np.where(recorded, -1, 1) * (rows @ weights)).sum()
        return float(total + RIDGE * (weights[1:] ** 2).sum())

    return minimize(loss, np.zeros_like(WEIGHTS), method="BFGS").x


def stated(photos: Sequence[Fronts], weights: np.ndarray) -> list[float]:
    """Return what weights state of every front."""
    return [float(p) for rows, _ in photos for p in 1 / (1 + np.exp(-rows @ weights))]


def crossed(photos: Sequence[Fronts]) -> Reliability | None:
    """Hold what is stated of each part by weights of the others against the labels."""
    said, true = [], []
    for part in range(PARTS):
        others = [one for i, one in enumerate(photos) if i % PARTS != part]
        said += stated(photos[part::PARTS], fit(others))
        true += [bool(r) for _, one in photos[part::PARTS] for r in one]
    return reliability(said, true)


def right(photos: Sequence[Fronts], weights: Float[np.ndarray, " 7"]) -> float:
    """Return the share of photos whose front of most merit is one recorded."""
    return float(np.mean([r[int(np.argmax(x @ weights))] for x, r in photos]))


def fronts(samples: Iterable[Sample], network: Network) -> list[Fronts]:
    """Return what the rule weighs, for every front of every photo with a target."""
    made = []
    for sample in samples:
        targets = [t for t in sample.things if t.target]
        photo = framed(sample.name, sample.image)
        instances = segment.segment(photo, network)
        if not targets or isinstance(instances, Rejection):
            continue
        found = matte.fronts(photo, instances)
        if isinstance(found, Rejection):
            continue
        shape = sample.image.shape
        aims = [fill(t.rings, shape) for t in targets]
        hiders = [fill(t.rings, shape) for t in sample.things if t.layer]
        hidden = np.any([np.zeros(shape, bool), *hiders], axis=0)
        recorded = [
            max(overlap(f.mask & ~hidden, a & ~hidden) for a in aims) >= 0.5
            for f in found[1]
        ]
        made.append((_weighed(photo, instances, found[1]), np.array(recorded)))
    return made


def _weighed(
    photo: Photo, instances: Sequence[Instance], facades: Sequence[Facade]
) -> Float[np.ndarray, "n 7"]:
    board = placard.board(instances)
    aim = None if board is None else board.box
    pointed = None if aim is None else placard.arrow(photo, aim).x
    shown = [Shown(one.mask, one.amodal, one.score) for one in facades]
    return features(shown, photo.frame, aim, pointed)


def main() -> None:
    """Fit on the blocks trained on, and check on the one held out."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--answers", type=Path, help="folder of what is remembered")
    args = parser.parse_args()
    folder, network = args.data / "taxphotos", shipped(args.answers)
    learnt = fronts(read_folder(folder), network)
    held = fronts(read_folder(folder, held_out=True), network)
    weights = fit(learnt)
    print("weights", np.round(weights, 2).tolist())
    print(
        f"right: {right(learnt, weights):.3f} fitted, {right(held, weights):.3f} held"
    )
    print("stated of parts by the others:", crossed(learnt))
    told = [bool(r) for _, one in held for r in one]
    print("stated of what was held:", reliability(stated(held, weights), told))
    print(f"before: {right(learnt, WEIGHTS):.3f}, {right(held, WEIGHTS):.3f}")


if __name__ == "__main__":
    main()
