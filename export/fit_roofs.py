"""The 23 weights of `nostalgin_core/segment/roofs.py` are fitted to hand labels.

Cutting a front off above a row gains what lies there on no labelled front and costs
`DEAR` times what lies on one, as shares of what is to be seen of the front; far rows
are left out. First the rows that gain most are made likeliest, then the weights go on,
not far, to where the gain that is to be expected is largest: a cut a row beside the
best one costs next to nothing, one through a front much. Tax blocks 996 and 997 and
nine in ten of the streets are learnt from, block 993 and the rest are not.

    python -m export.fit_roofs --data DATA --answers .train/answers
"""

import argparse
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final, NamedTuple

import cv2
import numpy as np
from jaxtyping import Float, Float32, Int
from scipy.optimize import minimize

from export.remembered import shipped
from export.segmentation_data import Sample, fill, read_folder
from nostalgin_core.photo import framed
from nostalgin_core.records import Rejection
from nostalgin_core.segment import Network
from nostalgin_core.segment.laid import Patch
from nostalgin_core.segment.roofs import straightened
from nostalgin_core.segment.rows import features
from nostalgin_core.segment.segment import everything, trusted

LEAST: Final = 0.2  # score of what is asked for, as `segment` asks
FOLDERS: Final = ("taxphotos", "historic_streets")
DEAR: Final = 1.5  # of a front's pixel, where a wall's is worth 1
WORTH: Final = 0.04  # of a front, from which a row is its roof
STEP: Final = 3  # rows: neighbours say the same
SHRUNK: Final = 3.0  # how firmly weights are held to 0
HELD: Final = 0.05  # and then to where they are
ROUNDS: Final = 30
FEWEST: Final = 300  # texels of a front that labels tell of

Weights = Float[np.ndarray, " f"]


class Rows(NamedTuple):
    """Rows of fronts that may be roofs, and what a cut there would gain."""

    told: Float[np.ndarray, "n f"]
    gain: Float[np.ndarray, " n"]
    start: Int[np.ndarray, " fronts"]  # each front's first row


def fit(rows: Rows) -> Weights:
    """Return the weights under which cuts are worth most."""
    middle, spread = rows.told.mean(0), rows.told.std(0) + 1e-6
    middle[0], spread[0] = 0.0, 1.0
    even = rows._replace(
        told=(rows.told - middle) / spread,
        gain=np.where(rows.gain < 0, DEAR, 1.0) * rows.gain,
    )
    first = np.zeros(rows.told.shape[1])
    first[0] = -6.0
    likeliest = minimize(unlikely, first, (even,), method="L-BFGS-B", jac=True).x
    asked = (even, likeliest)
    options = {"maxiter": ROUNDS}
    best = minimize(lost, likeliest, asked, "L-BFGS-B", jac=True, options=options).x
    weights = best / spread
    weights[0] -= weights[1:] @ middle[1:]
    return weights


def probable(
    weights: Weights, rows: Rows
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " fronts"]]:
    """Return each row's probability, and the logarithm that a front's rows share."""
    merit = rows.told @ weights
    own = owners(rows)
    top = np.maximum(np.maximum.reduceat(merit, rows.start), 0)
    total = np.add.reduceat(np.exp(merit - top[own]), rows.start) + np.exp(-top)
    shared = np.log(total) + top
    return np.exp(merit - shared[own]), shared


def owners(rows: Rows) -> Int[np.ndarray, " n"]:
    """Number each row's front."""
    lengths = np.diff(np.append(rows.start, len(rows.gain)))
    return np.repeat(np.arange(len(lengths)), lengths)


def unlikely(weights: Weights, rows: Rows) -> tuple[float, Weights]:
    """Measure how unlikely true roofs are (with its slope)."""
    aim = np.zeros(len(rows.gain))
    stops = np.append(rows.start[1:], len(rows.gain))
    for start, stop in zip(rows.start, stops, strict=True):
        best = start + int(rows.gain[start:stop].argmax())
        if rows.gain[best] > WORTH:
            near = np.arange(max(start, best - 1), min(stop, best + 2))
            aim[near] = 1 / len(near)
    likely, shared = probable(weights, rows)
    held = np.append(0.0, weights[1:])
    cost = shared.sum() - aim @ (rows.told @ weights) + SHRUNK * held @ held
    return float(cost), rows.told.T @ (likely - aim) + 2 * SHRUNK * held


def lost(weights: Weights, rows: Rows, around: Weights) -> tuple[float, Weights]:
    """Measure what cuts lose, by their probabilities (with its slope)."""
    likely, _ = probable(weights, rows)
    expected = np.add.reduceat(likely * rows.gain, rows.start)
    held = np.append(0.0, (weights - around)[1:])
    slope = rows.told.T @ (likely * (rows.gain - expected[owners(rows)]))
    return float(HELD * held @ held - expected.sum()), 2 * HELD * held - slope


def seen(samples: Iterable[Sample], network: Network) -> Rows:
    """Return what rows tell of every front found, and what cuts there would gain."""
    told, gain, start, count = [], [], [], 0
    for sample in samples:
        for front, worth in judged(sample, network):
            told.append(front)
            gain.append(worth)
            start.append(count)
            count += len(worth)
    return Rows(np.concatenate(told), np.concatenate(gain), np.array(start))


def judged(
    sample: Sample, network: Network
) -> Iterator[tuple[Float[np.ndarray, "n f"], Float[np.ndarray, " n"]]]:
    """Yield the rows of each front of a photograph, and what cuts there would gain."""
    photo = framed(sample.name, sample.image)
    found = everything(photo, network, least=LEAST)
    things = trusted(photo, found, roofed=False)
    if isinstance(things, Rejection):
        return
    true = labelled(sample)
    for number, patch, shown in straightened(photo, things, found.pixels):
        rows, open_to = features(shown, things[number].score)
        worth = gains(shown.visible, patch, true)
        picked = np.flatnonzero(open_to)[::STEP]
        if worth is not None and len(picked):
            yield rows[picked], worth[picked]


def labelled(sample: Sample) -> Float32[np.ndarray, "h w"]:
    """Mark labelled fronts with 1, what nobody can judge with nan, the rest with 0."""
    shape = sample.image.shape
    true = np.zeros(shape, np.float32)
    fronts = [one for one in sample.things if one.category == "facade"]
    for one in sorted(fronts, key=lambda one: one.scored):
        true[fill(one.rings, shape)] = 1 if one.scored else np.nan
    return true


def gains(
    visible: Float32[np.ndarray, "h w"], patch: Patch, true: np.ndarray
) -> Float[np.ndarray, " h"] | None:
    """Return what a cut above each row of a patch gains, None where little is told."""
    flags = cv2.INTER_NEAREST | cv2.WARP_INVERSE_MAP
    here = cv2.warpPerspective(true, patch.photo_from_patch, patch.size, flags=flags)
    told = (visible > 0.5) & ~np.isnan(here)
    if np.count_nonzero(told) < FEWEST:
        return None
    wall = np.where(told, 1 - 2 * np.nan_to_num(here), 0).sum(1)
    return np.append(0.0, np.cumsum(wall)[:-1]) / np.count_nonzero(told)


def main() -> None:
    """Fit, and print the weights and what the likeliest cuts gain."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--answers", type=Path, help="folder of what is remembered")
    args = parser.parse_args()
    network = shipped(args.answers)
    for kept in (False, True):
        samples = [
            one
            for name in FOLDERS
            for one in read_folder(args.data / name, held_out=kept)
        ]
        rows = seen(samples, network)
        if not kept:
            weights = fit(rows)
            print("weights", np.round(weights, 2).tolist())
        chosen = cuts(weights, rows)
        gain = rows.gain[chosen]
        print(
            f"{len(chosen)} cuts of {len(rows.start)} fronts, {sum(gain < 0)} of them "
            f"worse than none; {gain.sum() / len(rows.start):+.4f} of a front"
        )


def cuts(weights: Weights, rows: Rows) -> list[int]:
    """List the rows at which fronts are cut off."""
    merit = rows.told @ weights
    stops = np.append(rows.start[1:], len(merit))
    best = [
        start + int(merit[start:stop].argmax())
        for start, stop in zip(rows.start, stops, strict=True)
    ]
    return [row for row in best if merit[row] > 0]


if __name__ == "__main__":
    main()
