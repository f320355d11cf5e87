"""The ten weights of `nostalgin_core/segment/walls.py` are fitted to hand labels.

Every front that the network gives a score of a quarter is a wall where less than half
of what is to be seen of it lies on labelled fronts; far rows are left out. Tax blocks
996 and 997 and nine in ten of the streets are learnt from, block 993 and the rest are
not.
The weights minimise the logistic loss, summed over fronts, plus their squares, each as
the spread of its feature has it.

    python -m export.fit_walls --data DATA --answers .train/answers
"""

import argparse
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float
from scipy.optimize import minimize

from export.remembered import shipped
from export.segmentation_data import Sample, fill, read_folder
from nostalgin_core.photo import framed
from nostalgin_core.records import Instance
from nostalgin_core.segment import Network
from nostalgin_core.segment.hiding import hiding
from nostalgin_core.segment.pixels import mended
from nostalgin_core.segment.segment import everything
from nostalgin_core.segment.walls import before, features, planes

LEAST = 0.25  # score of a front
FOLDERS = ("taxphotos", "historic_streets")


def fit(
    rows: Float[np.ndarray, "n 10"], walls: Bool[np.ndarray, " n"]
) -> Float[np.ndarray, " 10"]:
    """Return the weights under which walls are likeliest told."""
    middle, spread = rows.mean(0), rows.std(0) + 1e-6
    middle[0], spread[0] = 0.0, 1.0
    even = (rows - middle) / spread

    def loss(weights: np.ndarray) -> float:
        total = np.logaddexp(0, np.where(walls, -1, 1) * (even @ weights)).sum()
        return float(total + (weights[1:] ** 2).sum())

    weights = minimize(loss, np.zeros(rows.shape[1]), method="L-BFGS-B").x / spread
    weights[0] -= weights[1:] @ middle[1:]
    return weights


def fronts(
    samples: Iterable[Sample], network: Network
) -> tuple[Float[np.ndarray, "n 10"], Bool[np.ndarray, " n"]]:
    """Return what is weighed of every front found, and which are walls."""
    rows, walls = [], []
    for sample in samples:
        photo = framed(sample.name, sample.image)
        found = everything(photo, network, least=LEAST)
        things = mended(hiding(found.things), found.pixels, photo.frame)
        seen, hidden = planes(photo, found.pixels), before(things, photo.frame)
        for one in things:
            wall = _wall(one, sample) if one.category == "facade" else None
            if wall is not None:
                rows.append(features(one, seen, hidden, photo.frame))
                walls.append(wall)
    return np.array(rows).reshape(-1, 10), np.array(walls, bool)


def _wall(one: Instance, sample: Sample) -> bool | None:
    """Tell whether what truly shows of a front is a wall, None where nobody can."""
    shape = sample.image.shape
    mask = np.zeros(shape, bool)
    x0, y0, x1, y1 = one.box
    mask[y0:y1, x0:x1] = one.probability > 0.5
    for thing in sample.things:
        if thing.layer:
            mask &= ~fill(thing.rings, shape)
    every, far = np.zeros(shape, bool), np.zeros(shape, bool)
    for thing in sample.things:
        if thing.category == "facade":
            (every if thing.scored else far)[fill(thing.rings, shape)] = True
    told = mask & ~(far & ~every)
    if not told.any() or 2 * told.sum() < mask.sum():
        return None
    return bool(2 * (told & every).sum() < told.sum())


def main() -> None:
    """Fit, and print the weights and how many walls are told apart where none was."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--answers", type=Path, help="folder of what is remembered")
    args = parser.parse_args()
    data, network = args.data, shipped(args.answers)
    for kept in (False, True):
        samples = [
            one for name in FOLDERS for one in read_folder(data / name, held_out=kept)
        ]
        rows, walls = fronts(samples, network)
        if not kept:
            weights = fit(rows, walls)
            print("weights", np.round(weights, 2).tolist())
        surer = (rows[walls] @ weights)[:, None] > (rows[~walls] @ weights)[None]
        print(
            f"{walls.sum()} walls of {len(walls)}: area under the curve", surer.mean()
        )


if __name__ == "__main__":
    main()
