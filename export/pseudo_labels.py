"""Photographs that nobody outlined teach, too, where several views of one agree.

Radosavovic et al., "Data Distillation", CVPR 2018: the network is asked about a photo
at several scales and mirrored; what most views find with one voice is taken for truth,
with the mean of their masks. What they disagree about is left unscored, so that the
student is neither praised nor blamed for it.

    python -m export.pseudo_labels DATA FOLDER
"""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import cv2
import numpy as np

from export.mask_rcnn_onnx import open_shipped
from export.painted_segmentation_data import rings
from export.segmentation_data import Sample, Thing
from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.records import Box, Instance, Photo
from nostalgin_core.segment import CATEGORIES, Network
from nostalgin_core.segment.segment import everything

VIEWS = ((416, False), (416, True), (352, False), (512, False))  # short side, mirrored
SAME = 0.5  # overlap at which two views speak of one thing
AGREED = 0.5  # mean score, over all views, from which a thing is believed
DOUBTED = 0.1  # mean score below which a thing is not even doubted
BELIEVED_VIEWS = 3
UNSURE = 128  # added to a layer's value where a thing is unscored


@dataclass(slots=True, eq=False)
class Cluster:
    """What several views say of one thing; `said` has at most one answer a view."""

    lead: Instance
    said: dict[int, Instance] = field(default_factory=dict)

    @property
    def score(self) -> float:
        """Give the mean score over all views, silent ones included."""
        return sum(i.score for i in self.said.values()) / len(VIEWS)

    @property
    def believed(self) -> bool:
        """Tell whether enough views are sure enough."""
        return self.score >= AGREED and len(self.said) >= BELIEVED_VIEWS

    def mask(self, shape: tuple[int, int]) -> Mask:
        """Give the pixels that the views find likelier than not, on average."""
        mean = np.zeros(shape, np.float32)
        for one in self.said.values():
            x0, y0, x1, y1 = one.box
            mean[y0:y1, x0:x1] += one.probability
        return mean > 0.5 * len(self.said)


def looked_at(image: Gray, network: Network) -> list[tuple[Instance, ...]]:
    """Ask a network about every view of a photo; answers lie in the photo's pixels."""
    height, width = image.shape
    frame = Box(0, 0, width, height)
    answers = []
    for short_px, mirrored in VIEWS:
        seen = np.ascontiguousarray(image[:, ::-1]) if mirrored else image
        photo = Photo("unlabelled", seen, frame)
        found = everything(photo, network, least=0.2, short_px=short_px).things
        answers.append(tuple(_mirror(i, width) if mirrored else i for i in found))
    return answers


def _mirror(one: Instance, width: int) -> Instance:
    x0, y0, x1, y1 = one.box
    box = Box(width - x1, y0, width - x0, y1)
    return Instance(one.category, one.score, box, one.probability[:, ::-1])


def clusters(answers: Sequence[Sequence[Instance]]) -> list[Cluster]:
    """Gather what the views say of the same things, surest first."""
    flat = [(one, view) for view, found in enumerate(answers) for one in found]
    gathered: list[Cluster] = []
    for one, view in sorted(flat, key=lambda pair: -pair[0].score):
        rivals = [
            (shared(c.lead, one), c)
            for c in gathered
            if view not in c.said and c.lead.category == one.category
        ]
        overlap, best = max(rivals, key=lambda r: r[0], default=(0.0, None))
        if best is None or overlap < SAME:
            best = Cluster(one)
            gathered.append(best)
        best.said[view] = one
    return gathered


def shared(a: Instance, b: Instance) -> float:
    """Return the overlap of two masks, over their union."""
    low, high = np.maximum(a.box[:2], b.box[:2]), np.minimum(a.box[2:], b.box[2:])
    if (high <= low).any():
        return 0.0
    parts = []
    for one in (a, b):
        (x0, y0), (x1, y1) = low - one.box[:2], high - one.box[:2]
        parts.append(one.probability[y0:y1, x0:x1] > 0.5)
    both = np.count_nonzero(parts[0] & parts[1])
    either = sum(np.count_nonzero(i.probability > 0.5) for i in (a, b)) - both
    return both / max(1, either)


def layers(image: Gray, network: Network) -> np.ndarray:
    """Return a layer a thing, valued category + 1, plus `UNSURE` where it is doubted.

    Pixels that several believed fronts claim go to the surest.
    """
    taken = np.zeros(image.shape, bool)
    found = []
    for one in sorted(clusters(looked_at(image, network)), key=lambda c: -c.score):
        if one.score < DOUBTED:
            continue
        mask = one.mask(image.shape)
        if one.believed and one.lead.category == "facade":
            mask &= ~taken
            taken |= mask
        if mask.any():
            value = CATEGORIES.index(one.lead.category) + 1
            found.append(mask * np.uint8(value + UNSURE * (not one.believed)))
    return np.stack(found) if found else np.zeros((0, *image.shape), np.uint8)


def read_pseudo(photos: Path, folder: Path) -> list[Sample]:
    """Read the photos of a folder that have layers, and at least one believed front."""
    samples = []
    for path in sorted(folder.glob("*.npz")):
        with np.load(path) as kept:
            stack = kept["layers"]
        if not (stack == 1).any():
            continue
        image = cv2.imread(str(photos / f"{path.stem}.jpg"), cv2.IMREAD_GRAYSCALE)
        if image is None:
            raise ValueError(f"layers without a photo: {path}")
        samples.append(Sample(path.stem, image, tuple(_thing(s) for s in stack)))
    return samples


def _thing(layer: np.ndarray) -> Thing:
    value = int(layer.max())
    category, believed = CATEGORIES[value % UNSURE - 1], value < UNSURE
    hides = int(believed and category != "facade")  # what is doubted takes nothing away
    return Thing(category, rings(layer > 0), hides, scored=believed)


def unlabelled(folder: Path) -> list[Path]:
    """Give a folder's photos that have no labels."""
    known = {p.stem for p in (folder / "labels").glob("*.json")}
    return [p for p in sorted((folder / "photos").glob("*.jpg")) if p.stem not in known]


def main() -> None:
    """Let the shipped network label what is not yet in the folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("folder", type=Path)
    args = parser.parse_args()
    teacher = open_shipped()
    args.folder.mkdir(parents=True, exist_ok=True)
    for photo in unlabelled(args.data / "historic_streets"):
        path = args.folder / f"{photo.stem}.npz"
        if path.exists():
            continue
        image = cv2.imread(str(photo), cv2.IMREAD_GRAYSCALE)
        if image is None:
            raise ValueError(f"not a picture: {photo}")
        partial = path.with_suffix(".partial")
        with partial.open("wb") as file:
            np.savez_compressed(file, layers=layers(image, teacher))
        partial.replace(path)


if __name__ == "__main__":
    main()
