"""Hand-drawn outlines become boxes, labels and masks of what a camera saw.

A *thing* is one outline: rings whose inside is what lies within an odd number of them,
so that a front may have holes and lie in pieces. Its visible part is its inside minus
every thing of a higher layer: fronts lie at layer 0, what stands before them at 1, what
augmentation pasted on top at 2 and more. Far rows that cannot be told apart (`group`)
are *unscored*: label -1 takes them out of the box head's losses, though proposals may
rest on them.
"""

import json
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Bool, Float, Int

from nostalgin_core.arrays import Gray, Points
from nostalgin_core.measure import labelled_fronts
from nostalgin_core.records import Category
from nostalgin_core.segment import CATEGORIES

HELD_OUT_BLOCK = labelled_fronts.HELD_OUT_BLOCK  # its labels are never trained on
UNSCORED = -1
SHIFT_BITS = 4  # sixteenths of a pixel for OpenCV's polygon filler
SMALLEST_PX = 6  # thinner boxes than this are left unscored


@dataclass(frozen=True, slots=True, eq=False)
class Thing:
    """One outline, in pixels of its photo."""

    category: Category
    rings: tuple[Points, ...]
    layer: int
    scored: bool = True
    target: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Sample:
    """A gray photograph and everything outlined in it."""

    name: str
    image: Gray
    things: tuple[Thing, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Truth:
    """What the network should answer for one image."""

    boxes: Float[np.ndarray, "n 4"]
    labels: Int[np.ndarray, " n"]
    masks: Bool[np.ndarray, "n h w"]


def kept_out(folder: str, stem: str) -> bool:
    """Tell whether training never sees a photo: block 993, a tenth of the streets."""
    if folder == "taxphotos":
        return stem.startswith(HELD_OUT_BLOCK)
    return labelled_fronts.held_out(folder, stem)


def read_folder(folder: Path, *, held_out: bool = False) -> list[Sample]:
    """Read the labelled photos of a folder, without those kept out, or only them."""
    photos = {p.stem: p for p in sorted((folder / "photos").glob("*.jpg"))}
    samples = []
    for path in sorted((folder / "labels").glob("*.json")):
        if kept_out(folder.name, path.stem) != held_out:
            continue
        photo = next(p for stem, p in photos.items() if stem.endswith(path.stem))
        samples.append(read_sample(photo, path))
    return samples


def some(samples: Sequence[Sample], share: float) -> list[Sample]:
    """Keep a share of the photographs, by the hash of their names.

    A smaller share is part of a larger one, so that a learning curve adds labels and
    changes none. Raises ValueError unless 0 < share <= 1.
    """
    if not 0 < share <= 1:
        raise ValueError(f"a share of the labels is above 0 and at most 1, not {share}")
    return [s for s in samples if zlib.crc32(s.name.encode()) < share * 2**32]


def read_sample(photo: Path, label: Path) -> Sample:
    """Read one photograph with its outlines."""
    image = cv2.imread(str(photo), cv2.IMREAD_GRAYSCALE)
    if image is None:
        raise ValueError(f"not a picture: {photo}")
    objects = json.loads(label.read_text())["objects"]
    return Sample(label.stem, image, tuple(_thing(o) for o in objects))


def _thing(labelled: dict) -> Thing:
    return Thing(
        category=labelled["category"],
        rings=(np.array(labelled["polygon"], float),),
        layer=0 if labelled["category"] == "facade" else 1,
        scored=not labelled.get("group", False),
        target=bool(labelled.get("target")),
    )


def fill(rings: Sequence[Points], shape: tuple[int, int]) -> Bool[np.ndarray, "h w"]:
    """Return the pixels inside an odd number of rings, the rings included."""
    canvas = np.zeros(shape, np.uint8)
    fixed = [np.round(ring * 2**SHIFT_BITS).astype(np.int32) for ring in rings]
    cv2.fillPoly(canvas, fixed, 1, shift=SHIFT_BITS)
    return canvas.astype(bool)


def truth(sample: Sample) -> Truth:
    """Rasterise a sample: visible masks, their boxes, and labels from 1."""
    shape = sample.image.shape
    covered = np.zeros(shape, bool)
    masks = {}
    for layer in sorted({t.layer for t in sample.things}, reverse=True):
        here = [i for i, t in enumerate(sample.things) if t.layer == layer]
        filled = {i: fill(sample.things[i].rings, shape) for i in here}
        masks |= {i: m & ~covered for i, m in filled.items()}
        for mask in filled.values():
            covered |= mask
    seen = [i for i in sorted(masks) if masks[i].sum() >= SMALLEST_PX**2 / 2]
    boxes = np.array([_box(masks[i]) for i in seen], np.float32).reshape(-1, 4)
    labels = np.array([_label(sample.things[i]) for i in seen], np.int64)
    labels[(boxes[:, 2:] - boxes[:, :2]).min(1, initial=1e9) < SMALLEST_PX] = UNSCORED
    stacked = np.array([masks[i] for i in seen], bool).reshape(-1, *shape)
    return Truth(boxes, labels, stacked)


def _label(thing: Thing) -> int:
    return CATEGORIES.index(thing.category) + 1 if thing.scored else UNSCORED


def _box(mask: Bool[np.ndarray, "h w"]) -> tuple[int, int, int, int]:
    xs, ys = np.flatnonzero(mask.any(0)), np.flatnonzero(mask.any(1))
    return xs[0], ys[0], xs[-1] + 1, ys[-1] + 1


def view(
    sample: Sample, rng: np.random.Generator, *, short_px: tuple[int, int] = (352, 544)
) -> Sample:
    """Scale, flip and cut a sample at random, as another camera would have.

    The short side falls between `short_px`; at most 672 pixels along each axis are
    kept, in the multiples of 32 that the network takes.
    """
    height, width = sample.image.shape
    scale = rng.uniform(*short_px) / min(height, width)
    sx, sy = scale * np.exp(rng.uniform(-0.08, 0.08, 2))
    size = max(64, round(width * sx)), max(64, round(height * sy))
    image = cv2.resize(sample.image, size, interpolation=cv2.INTER_AREA)
    keep_w, keep_h = (min(672, s // 32 * 32) for s in size)
    x0 = int(rng.integers(size[0] - keep_w + 1))
    y0 = int(rng.integers(size[1] - keep_h + 1))
    flipped = rng.random() < 0.5
    image = image[y0 : y0 + keep_h, x0 : x0 + keep_w]
    if flipped:
        image = image[:, ::-1]

    def moved(ring: Points) -> Points:
        polygon = (ring + 0.5) * (size[0] / width, size[1] / height) - 0.5
        polygon = polygon - (x0, y0)
        if flipped:
            polygon = polygon * (-1, 1) + (keep_w - 1, 0)
        return polygon

    things = tuple(
        replace(t, rings=tuple(moved(ring) for ring in t.rings)) for t in sample.things
    )
    return Sample(sample.name, np.ascontiguousarray(image), things)


def tilted(sample: Sample, rng: np.random.Generator) -> Sample:
    """Turn a sample by a degree or two and let its walls lean, as cameras do."""
    height, width = sample.image.shape
    turn = cv2.getRotationMatrix2D(
        (width / 2, height / 2), float(rng.normal(0, 1.5)), 1.0
    )
    lean = rng.normal(0, 0.03)
    turn[0] += (0, lean, -lean * height / 2)
    image = cv2.warpAffine(
        sample.image, turn, (width, height), borderMode=cv2.BORDER_REPLICATE
    )

    def moved(ring: Points) -> Points:
        return ring @ turn[:, :2].T + turn[:, 2]

    things = tuple(
        replace(t, rings=tuple(moved(ring) for ring in t.rings)) for t in sample.things
    )
    return Sample(sample.name, image, things)
