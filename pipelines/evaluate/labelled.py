"""Labelled photographs: is a hand-drawn quad a rectangle once we have flattened it?

Rectification gets the labels as perfect masks. Of every front that was straightened,
the worst of the labelled quad's four angles counts; labels err by about 2 px, which
alone makes 1.6 degrees in the median and 4 at the 90th percentile. Groups, whose quads
are guesses, are never scored, nor given to the rectifier.
"""

import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from nostalgin_core import photo, rectify
from nostalgin_core.measure import rectification
from nostalgin_core.records import Elevation, Facade, Matted, Occluder, Photo, Rejection
from nostalgin_core.rectify import lines
from pipelines.evaluate import Unmeasurable, labels


@dataclass(frozen=True, slots=True, eq=False)
class Labelled:
    """A photograph, its labelled fronts, and what became of each."""

    label: dict[str, Any]
    photo: Photo
    fronts: list[dict[str, Any]]
    results: tuple[Elevation | Rejection, ...]  # one a front
    seconds: float  # CPU


def straightened(
    folder: Path, *, block: str = "", detector: lines.Detector = lines.detect
) -> Iterator[Labelled]:
    """Straighten the labelled fronts of each photo, in the order of the labels' names.

    Raises:
        Unmeasurable: if a file can't be read as a photo.
    """
    for label, image, fronts, matted in photographs(folder, block=block):
        start = time.process_time()
        results = rectify.rectify(image, matted, detector=detector)
        seconds = time.process_time() - start
        yield Labelled(label, image, fronts, results, seconds)


def photographs(
    folder: Path, *, block: str = ""
) -> Iterator[tuple[dict[str, Any], Photo, list[dict[str, Any]], Matted]]:
    """Read each label, its photo, its fronts and the masks that it makes.

    Raises:
        Unmeasurable: if a file can't be read as a photo.
    """
    for label, file in labels.pairs(folder, block=block):
        image = photo.decode(file.read_bytes(), name=file.name)
        if isinstance(image, Rejection):
            raise Unmeasurable(f"{file}: {image.reason}: {image.detail}")
        yield label, image, *matted_from(label, image)


def summed(photographs: list[Labelled]) -> dict[str, Any]:
    """Sum up the worst angles: of the targets alone, and of all fronts."""
    seconds = [one.seconds for one in photographs]
    pairs = [
        (front, result)
        for one in photographs
        for front, result in zip(one.fronts, one.results, strict=True)
    ]
    reasons = Counter(r.reason for _, r in pairs if isinstance(r, Rejection))
    summary: dict[str, Any] = {
        "photographs": len(photographs),
        "rejections": dict(sorted(reasons.items())),
        "cpu_seconds_median": float(np.median(seconds)) if seconds else None,
    }
    for kind in ("target", "all"):
        counted = [(f, r) for f, r in pairs if kind == "all" or f.get("target")]
        angles = [a for f, r in counted if (a := worst_angle_deg(f, r)) is not None]
        summary |= {
            f"{kind}_fronts": len(counted),
            f"{kind}_straightened": len(angles),
            f"{kind}_angle_median": _quantile(angles, 0.5),
            f"{kind}_angle_p90": _quantile(angles, 0.9),
        }
    return summary


def worst_angle_deg(
    front: dict[str, Any], result: Elevation | Rejection
) -> float | None:
    """Measure the labelled quad's worst angle; None where nothing came of a front."""
    if not isinstance(result, Elevation):
        return None
    quad = np.array(front["quad"], np.float64)
    return rectification.worst_angle_deg(quad, result.photo_from_elevation)


def _quantile(values: list[float], share: float) -> float | None:
    """Give a quantile, or None of nothing."""
    return float(np.quantile(values, share)) if values else None


def matted_from(
    label: dict[str, Any], image: Photo
) -> tuple[list[dict[str, Any]], Matted]:
    """Make of a label what perfect segmentation and matting would say."""
    shape = image.image.shape
    fronts = [
        one
        for one in label["objects"]
        if one["category"] == "facade" and not one.get("group")
    ]
    occluders = tuple(
        Occluder(one["category"], 1.0, labels.filled(one["polygon"], shape))
        for one in label["objects"]
        if one["category"] != "facade"
    )
    hidden = labels.union([one.mask for one in occluders], shape)
    facades = []
    for index, one in enumerate(fronts):
        amodal = labels.filled(one["polygon"], shape)
        target = bool(one.get("target"))
        alpha = (amodal & ~hidden).astype(np.float32)
        facades.append(
            Facade(index, 1.0, target, float(target), amodal & ~hidden, amodal, alpha)
        )
    return fronts, Matted(tuple(facades), occluders)
