"""The six weights of `nostalgin_core/matte/target.py` are fitted to hand labels.

Each labelled tax photo gives its fronts twice: as outlined by hand, with the score 0.9,
and as the network finds them, their sides made straight as in a build. A front found
counts as recorded where it overlaps a labelled target by a half or more. The weights
minimise the logistic loss, summed over fronts and averaged over photos, plus a
hundredth of their squares.

    python -m export.fit_target --data DATA
"""

import argparse
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float
from scipy.optimize import minimize

from export.mask_rcnn_onnx import open_shipped
from export.segmentation_data import Sample, fill, read_folder
from nostalgin_core import matte, placard, segment
from nostalgin_core.arrays import Mask
from nostalgin_core.matte.target import WEIGHTS, features
from nostalgin_core.measure.segmentation import overlap
from nostalgin_core.records import Box, Instance, Photo, Rejection
from nostalgin_core.segment import Network

Fronts = tuple[Float[np.ndarray, "n 6"], Bool[np.ndarray, " n"]]
LABELLED_SCORE = 0.9
RIDGE = 0.01


def fit(photos: Sequence[Fronts]) -> Float[np.ndarray, " 6"]:
    """Return the weights under which the recorded fronts are likeliest."""

    def loss(weights: np.ndarray) -> float:
        total = sum(
            np.logaddexp(0, np.where(recorded, -1, 1) * (rows @ weights)).sum()
            for rows, recorded in photos
        )
        return float(total / len(photos) + RIDGE * (weights[1:] ** 2).sum())

    return minimize(loss, WEIGHTS, method="BFGS").x


def right(photos: Sequence[Fronts], weights: Float[np.ndarray, " 6"]) -> float:
    """Return the share of photos whose front of most merit is one recorded."""
    return float(np.mean([r[int(np.argmax(x @ weights))] for x, r in photos]))


def fronts(samples: Iterable[Sample], network: Network) -> list[Fronts]:
    """Return what the rule weighs, for every front of every photo with a target."""
    made = []
    for sample in samples:
        targets = [t for t in sample.things if t.target]
        height, width = sample.image.shape
        photo = Photo(sample.name, sample.image, Box(0, 0, width, height))
        instances = segment.segment(photo, network)
        if not targets or isinstance(instances, Rejection):
            continue
        board = placard.board(instances)
        aim = None if board is None else board.box
        shape = sample.image.shape
        aims = [fill(t.rings, shape) for t in targets]
        for masks, scores in (_labelled(sample), _found(photo, instances)):
            if masks:
                rows = [
                    features(m, s, photo.frame, aim)
                    for m, s in zip(masks, scores, strict=True)
                ]
                recorded = [max(overlap(m, a) for a in aims) >= 0.5 for m in masks]
                made.append((np.array(rows), np.array(recorded)))
    return made


def _labelled(sample: Sample) -> tuple[list[Mask], list[float]]:
    shape = sample.image.shape
    outlined = [
        fill(t.rings, shape)
        for t in sample.things
        if t.category == "facade" and t.scored
    ]
    return outlined, [LABELLED_SCORE] * len(outlined)


def _found(
    photo: Photo, instances: Sequence[Instance]
) -> tuple[list[Mask], list[float]]:
    found = matte.fronts(photo, instances)
    if isinstance(found, Rejection):
        return [], []
    _, facades = found
    return [f.mask for f in facades], [f.score for f in facades]


def main() -> None:
    """Fit on the blocks trained on, and check on the one held out."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True)
    folder = parser.parse_args().data / "taxphotos"
    network = open_shipped()
    learnt = fronts(read_folder(folder), network)
    held = fronts(read_folder(folder, held_out=True), network)
    weights = fit(learnt)
    print("weights", np.round(weights, 2).tolist())
    print(
        f"right: {right(learnt, weights):.3f} fitted, {right(held, weights):.3f} held"
    )
    print(f"before: {right(learnt, WEIGHTS):.3f}, {right(held, WEIGHTS):.3f}")


if __name__ == "__main__":
    main()
