"""Whether two photographs' fronts are told to be one, held against labels.

Labelled fronts are straightened by their labelled quads, so that nothing but the
comparison is measured: how often pairs of one front are told, how often pairs of two
are taken for one, how far an overlay carries corners from where the labels have them.
"""

import hashlib
import itertools
import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Final, NamedTuple

import cv2
import numpy as np

from nostalgin_core import photo, views
from nostalgin_core.measure.labelled_fronts import straightened
from nostalgin_core.records import Rejection
from nostalgin_core.views import Marks, View
from pipelines.evaluate import Unmeasurable, labels

ONE_IN: Final = 16  # of pairs of two fronts: there are very many
STATED: Final = (0.5, 0.8, 0.95, 0.99)
SURE: Final = 0.8


class Front(NamedTuple):
    """A labelled front of one photograph."""

    photo: str
    number: int  # of the label's object
    lots: frozenset[str]
    side: str  # the street it faces
    view: View
    marks: Marks


class Pair(NamedTuple):
    """What is told of two fronts, and what is true."""

    same: bool
    probability: float
    error: float  # median of the corners', as a share of the longer side; of one front


def evaluate(folder: Path, *, block: str = "") -> dict[str, Any]:
    """Compare fronts of each block's photographs, pair by pair.

    Raises:
        Unmeasurable: if nothing tells which lot a front is of.
    """
    try:
        lots = json.loads((folder / "lots.json").read_text())
    except (OSError, ValueError) as problem:
        raise Unmeasurable(f"{folder / 'lots.json'}: {problem}") from problem
    found = list(fronts(labels.pairs(folder, block=block), lots))
    pairs = [told(a, b) for a, b in itertools.combinations(found, 2) if wanted(a, b)]
    if not any(pair.same for pair in pairs):
        raise Unmeasurable(f"{folder} shows no front twice")
    return summed(pairs)


def fronts(
    labelled: Iterable[tuple[dict[str, Any], Path]], lots: dict[str, Any]
) -> Iterator[Front]:
    """Straighten the labelled fronts whose lots are known."""
    for label, path in labelled:
        name = label.get("id", path.stem)
        known = {each["object"]: each for each in lots.get(name, ())}
        read = photo.decode(path.read_bytes(), name=path.name)
        if isinstance(read, Rejection):
            raise Unmeasurable(f"{path}: {read.reason}: {read.detail}")
        for number, image, seen in straightened(read.image, label["objects"]):
            whose = known.get(number)
            if whose is None or whose["lot"] is None:
                continue
            every = frozenset((whose["lot"], *whose.get("also", ())))
            view = View(image, seen)
            marks = views.marks(view)
            yield Front(name, number, every, whose["front"], view, marks)


def wanted(a: Front, b: Front) -> bool:
    """Take all pairs of one front, and some of two; of outlines in part, none."""
    if a.photo == b.photo or block_of(a) != block_of(b):
        return False
    if a.lots & b.lots:
        return a.lots == b.lots and a.side == b.side
    name = f"{a.photo} {a.number} {b.photo} {b.number}"
    return hashlib.sha256(name.encode()).digest()[0] % ONE_IN == 0


def block_of(front: Front) -> str:
    """Name the block of a front."""
    return min(front.lots).partition("-")[0]


def told(a: Front, b: Front) -> Pair:
    """Compare two fronts."""
    same = a.lots == b.lots
    found = views.overlay(a.marks, b.marks)
    if found is None:
        return Pair(same, views.probability(0.0, 0.0), np.inf)
    alike = views.likeness(a.view, b.view, found.matrix)
    probability = views.probability(found.support, alike)
    here, there = (corners(*one.view.image.shape) for one in (a, b))
    off = cv2.perspectiveTransform(here[None], found.matrix)[0] - there
    error = np.median(np.linalg.norm(off, axis=1)) / max(b.view.image.shape)
    return Pair(same, probability, float(error))


def corners(height: int, width: int) -> np.ndarray:
    """List a picture's corners."""
    x, y = width - 1.0, height - 1.0
    return np.array([[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]])


def summed(pairs: list[Pair]) -> dict[str, Any]:
    """Sum up pairs of one front and of two."""
    one = np.array([pair.probability for pair in pairs if pair.same])
    two = np.array([pair.probability for pair in pairs if not pair.same])
    off = [p.error for p in pairs if p.same and p.probability > SURE]
    return {
        "pairs of one front": len(one),
        "pairs of two fronts": len(two),
        "told": {
            str(stated): {
                "of one front": float(np.mean(one > stated)),
                "of two fronts": float(np.mean(two > stated)) if len(two) else None,
            }
            for stated in STATED
        },
        "corners off, median": float(np.median(off)) if off else None,
    }


def text(report: dict[str, Any]) -> str:
    """Write the table."""
    counts = ("pairs of one front", "pairs of two fronts")
    lines = [f"{name:24}{report[name]:>8}" for name in counts]
    lines += ["", f"{'told to be one front':24}{'of one':>8}{'of two':>8}"]
    for stated, share in report["told"].items():
        shares = (share["of one front"], share["of two fronts"])
        cells = "".join("       -" if s is None else f"{s:8.3f}" for s in shares)
        lines.append(f"  stated above {stated:10}{cells}")
    off = report["corners off, median"]
    words = "-" if off is None else f"{off:.3f}"
    return "\n".join([*lines, "", f"corners off, median, where above {SURE}: {words}"])
