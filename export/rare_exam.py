"""Networks are examined on rare kinds: what becomes of the fronts that a kind touches.

Every photograph that was kept out of training is made one of a kind, with seeds that
training never draws. A front is asked for if the photograph changed on it or close to
it. Networks of one backbone share what it makes of a photograph, so that those which
learnt boxes alone cost little more than one.

    python -m export.rare_exam DATA WEIGHTS [WEIGHTS ...] --kinds walled hazy
"""

import argparse
import json
import zlib
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Final, NamedTuple

import cv2
import numpy as np
import torch
from torch import Tensor, nn

from export.held_out import as_callable, figures, found, labelled, whole
from export.mask_rcnn import Backbone, MaskRCNN, load_weights
from export.rare import KINDS, rare
from export.segmentation_data import Sample, fill, read_folder
from export.train_mask_rcnn import SETS
from export.weights import read_weights
from nostalgin_core.arrays import Mask
from nostalgin_core.measure.front_errors import errors
from nostalgin_core.segment import Network

SEED: Final = 993_000  # training draws from small ones
CHANGED: Final = 12  # gray levels
CLOSE: Final = 0.04  # of the photo's height, round a front
TOUCHED: Final = 0.03  # share of a front and what is close to it


class Scene(NamedTuple):
    """A photograph of a rare kind, and the fronts to ask for."""

    sample: Sample
    visible: tuple[Mask, ...]  # of the fronts that the kind touched
    others: tuple[Mask, ...]


class Shared(nn.Module):
    """A backbone that remembers what it made of each photograph."""

    def __init__(self, backbone: Backbone) -> None:
        """Remember nothing yet."""
        super().__init__()
        self.backbone = backbone
        self.made: dict[bytes, tuple[dict[str, Tensor], dict[str, Tensor]]] = {}

    def both(self, x: Tensor) -> tuple[dict[str, Tensor], dict[str, Tensor]]:
        """Return the body's four taps, and the five levels made of them."""
        name = x.numpy().tobytes()
        if name not in self.made:
            self.made[name] = self.backbone.both(x)
        taps, levels = self.made[name]
        return dict(taps), dict(levels)


def sharing(networks: Sequence[MaskRCNN]) -> Shared:
    """Let networks share their backbone; raises ValueError where they differ there."""
    shared = Shared(networks[0].backbone)
    kept = networks[0].backbone.state_dict()
    for network in networks:
        own = network.backbone.state_dict()
        if not all(torch.equal(kept[name], own[name]) for name in kept):
            raise ValueError("these networks do not share their backbone")
        network.add_module("backbone", shared)
    return shared


def scenes(samples: Sequence[Sample], kind: str, *, most: int) -> list[Scene]:
    """Make photographs ones of a kind, until there are `most` that it changes."""
    made: list[Scene] = []
    for number, sample in enumerate(samples):
        if len(made) == most:
            break
        after = rare(sample, np.random.default_rng([SEED, number]), (kind,))
        touched = _touched(sample, after)
        if any(touched):
            fronts = _visible(after)
            asked = tuple(m for m, t in zip(fronts, touched, strict=True) if t)
            rest = tuple(m for m, t in zip(fronts, touched, strict=True) if not t)
            made.append(Scene(after, asked, rest))
    return made


def fates(network: Network, scene: Scene) -> Counter[str]:
    """Count what became of the fronts that a kind touched, as `front_errors` names it.

    Fronts of which nothing is seen are left out.
    """
    every, hidden, counted = labelled(scene.sample)
    things = found(network, scene.sample)
    facades = [
        (whole(one, every.shape) > 0.5) & ~hidden
        for one in things
        if one.category == "facade"
    ]
    told = errors(facades, (*scene.visible, *scene.others), ~counted)
    return Counter(told.fates[: len(scene.visible)])


def _visible(sample: Sample) -> list[Mask]:
    _, hidden, _ = labelled(sample)
    fronts = [t for t in sample.things if t.category == "facade" and t.scored]
    masks = [fill(t.rings, hidden.shape) & ~hidden for t in fronts]
    return [mask for mask in masks if mask.any()]


def _touched(before: Sample, after: Sample) -> list[bool]:
    """Tell for each visible front whether the photograph changed on or close to it."""
    changed = cv2.absdiff(before.image, after.image) > CHANGED
    reach = 2 * round(CLOSE * before.image.shape[0]) + 1
    round_it = np.ones((reach, reach), np.uint8)
    near = (cv2.dilate(m.astype(np.uint8), round_it) > 0 for m in _visible(after))
    return [bool(changed[here].mean() >= TOUCHED) for here in near]


def main() -> None:
    """Print held-out figures, and what became of touched fronts, a JSON a line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("weights", type=Path, nargs="+", help=".pt, .npz or .onnx")
    parser.add_argument("--kinds", nargs="*", choices=KINDS, default=list(KINDS))
    parser.add_argument("--most", type=int, default=20, help="photographs a kind")
    args = parser.parse_args()
    torch.set_num_threads(1)
    networks = [load_weights(MaskRCNN(), read_weights(w)).eval() for w in args.weights]
    shared, samples = sharing(networks), []
    for name in SETS:
        kept = read_folder(args.data / name, held_out=True)
        samples += kept
        for path, network in zip(args.weights, networks, strict=True):
            row = figures(as_callable(network), kept)
            print(json.dumps({"set": name, "weights": str(path), **row}), flush=True)
        shared.made.clear()
    samples.sort(key=lambda s: zlib.crc32(s.name.encode()))  # streets among tax photos
    for kind in args.kinds:
        made = scenes(samples, kind, most=args.most)
        for path, network in zip(args.weights, networks, strict=True):
            ask = as_callable(network)
            row = sum((fates(ask, scene) for scene in made), Counter())
            print(json.dumps({"kind": kind, "weights": str(path), **row}), flush=True)
        shared.made.clear()


if __name__ == "__main__":
    main()
