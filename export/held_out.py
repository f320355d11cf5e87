"""A network is judged on photographs whose labels it never trained on.

Figures are means over photos: precision, recall and l1 of all visible front (the
paper's table 1, before matting), the share of fronts found at an overlap of a half,
the overlap of target fronts (median), and the share of what hides fronts that was
found. Far rows that cannot be told apart do not count.

    python -m export.held_out DATA CHECKPOINT [CHECKPOINT]
"""

import argparse
import json
from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
import torch

from export.mask_rcnn import MaskRCNN, load_weights
from export.segmentation_data import Sample, fill, read_folder
from export.semantic_branch import KINDS, probabilities
from export.weights import read_weights
from nostalgin_core import segment
from nostalgin_core.arrays import Mask
from nostalgin_core.measure.segmentation import agreement, overlap
from nostalgin_core.records import Box, Instance, Photo, Rejection
from nostalgin_core.segment import Network
from nostalgin_core.segment.segment import prepared

SHORT_PX, LONG_PX = 416, 1344  # the scale in use


def as_callable(network: MaskRCNN) -> Network:
    """Make a torch network look like the exported one: arrays in, arrays out."""

    @torch.inference_mode()
    def call(gray: np.ndarray) -> tuple[np.ndarray, ...]:
        image = torch.from_numpy(gray).to(memory_format=torch.channels_last)
        return tuple(part.numpy() for part in network(image))

    return call


def pixels_alone(network: MaskRCNN) -> Network:
    """Ask a torch network for its pixels alone."""

    @torch.inference_mode()
    def call(gray: np.ndarray) -> tuple[np.ndarray, ...]:
        image = torch.from_numpy(gray).to(memory_format=torch.channels_last)
        return (probabilities(network.pixel_logits(image))[0].numpy(),)

    return call


def together(*networks: Network) -> Network:
    """Let several networks answer as one, as the paper's two do.

    Their things are put together; of what they say about pixels, and of whether it is
    a room, the mean counts.
    """

    def call(gray: np.ndarray) -> tuple[np.ndarray, ...]:
        *things, pixels, rooms = zip(*(one(gray) for one in networks), strict=True)
        planes = (np.mean(plane, axis=0) for plane in (pixels, rooms))
        return (*map(np.concatenate, things), *planes)

    return call


def figures(network: Network, samples: Sequence[Sample]) -> dict[str, float]:
    """Judge a network on labelled photos."""
    rows = [judged(s, found(network, s)) for s in samples]
    names = [n for n in rows[0] if n not in ("fronts", "targets")]
    means = {n: [r[n] for r in rows if not np.isnan(r[n])] for n in names}
    result = {n: float(np.mean(v)) for n, v in means.items() if v}
    fronts = np.array([q for r in rows for q in r["fronts"]])
    targets = np.array([q for r in rows for q in r["targets"]])
    result["fronts_found"] = float((fronts >= 0.5).mean())
    if len(targets):
        result["target_overlap"] = float(np.median(targets))
        result["target_found"] = float((targets >= 0.5).mean())
    return {n: round(v, 4) for n, v in result.items()}


def found(network: Network, sample: Sample) -> tuple[Instance, ...]:
    """Segment a sample, frame and all; nothing where it was rejected."""
    height, width = sample.image.shape
    photo = Photo(sample.name, sample.image, Box(0, 0, width, height))
    instances = segment.segment(photo, network)
    return () if isinstance(instances, Rejection) else instances


def pixel_figures(ask: Network, samples: Sequence[Sample]) -> dict[str, float]:
    """Judge the semantic branch alone on labelled photos, each cell's likeliest kind.

    Far rows do not count. Means over photos.
    """
    rows = []
    for sample in samples:
        shape = sample.image.shape
        gray = prepared(sample.image, short_px=SHORT_PX, long_px=LONG_PX)
        pixels = ask(gray[None, None])[-1]
        full = [
            cv2.resize(p, shape[::-1], interpolation=cv2.INTER_LINEAR) for p in pixels
        ]
        kind = np.argmax(full[:KINDS], axis=0)
        every, hidden, counted = labelled(sample)
        seen = every & ~hidden
        score = agreement(full[1], seen, counted, threshold=0.5)
        on = hidden & every
        rows.append(
            {
                "precision": score.precision,
                "recall": score.recall,
                "l1": score.l1,
                "l2": score.l2,
                "hard": 100 * float(((kind == 1) != seen)[counted].mean()),
                "occluders": (kind == 2)[on].mean() if on.any() else float("nan"),
                "occluders_false": ((kind == 2) & seen).sum() / max(1, every.sum()),
            }
        )
    return {n: round(float(np.nanmean([r[n] for r in rows])), 4) for n in rows[0]}


def judged(sample: Sample, instances: Sequence[Instance]) -> dict:
    """Compare what was found in one photo with its labels."""
    shape = sample.image.shape
    fronts = [t for t in sample.things if t.category == "facade" and t.scored]
    outlined = [fill(t.rings, shape) for t in fronts]
    every, hidden, counted = labelled(sample)
    masks = [(i.category, whole(i, shape) > 0.5) for i in instances]
    facades = [m for category, m in masks if category == "facade"]
    before = _union([m for category, m in masks if category != "facade"], shape)
    claimed = _union(facades, shape) & ~before
    score = agreement(
        claimed.astype(np.float32), every & ~hidden, counted, threshold=0.5
    )
    overlaps = [
        max((overlap(m & ~hidden, w & ~hidden) for m in facades), default=0.0)
        for w in outlined
    ]
    aims = [q for t, q in zip(fronts, overlaps, strict=True) if t.target]
    on = hidden & every
    return {
        "precision": score.precision,
        "recall": score.recall,
        "l1": score.l1,
        "occluders": (before & on).sum() / on.sum() if on.any() else float("nan"),
        "occluders_false": (before & every & ~hidden).sum() / max(1, every.sum()),
        "fronts": overlaps,
        "targets": [max(aims)] if aims else [],
    }


def labelled(sample: Sample) -> tuple[Mask, Mask, Mask]:
    """Return all front, what hides anything, and what counts: no far row."""
    shape = sample.image.shape
    fronts = [t for t in sample.things if t.category == "facade"]
    hidden = _union([fill(t.rings, shape) for t in sample.things if t.layer], shape)
    every = _union([fill(t.rings, shape) for t in fronts if t.scored], shape)
    far = _union([fill(t.rings, shape) for t in fronts if not t.scored], shape)
    return every, hidden, ~(far & ~every)


def _union(masks: Sequence[np.ndarray], shape: tuple[int, int]) -> np.ndarray:
    return np.any(masks, axis=0) if len(masks) else np.zeros(shape, bool)


def whole(instance: Instance, shape: tuple[int, int]) -> np.ndarray:
    """Return a thing's probability over all of its photo."""
    canvas = np.zeros(shape, np.float32)
    x0, y0, x1, y1 = instance.box
    canvas[y0:y1, x0:x1] = instance.probability
    return canvas


def main() -> None:
    """Print the held-out figures of checkpoints that answer together, as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("weights", type=Path, nargs="+", help=".pt, .npz or .onnx")
    args = parser.parse_args()
    torch.set_num_threads(1)
    samples = read_folder(args.data / "taxphotos", held_out=True)
    networks = [
        as_callable(load_weights(MaskRCNN(), read_weights(path)).eval())
        for path in args.weights
    ]
    print(json.dumps(figures(together(*networks), samples)))


if __name__ == "__main__":
    main()
