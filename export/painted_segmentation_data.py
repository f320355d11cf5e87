"""Painted streets as labelled photographs, half of their fronts in real clothes.

Painting takes a second or two a photo, so that each is painted once and kept in a
folder; a photo is seeded by its number, and its truth is exact to the pixel.

    python -m export.painted_segmentation_data DATA FOLDER --count 240
"""

import argparse
from pathlib import Path

import cv2
import numpy as np

from export.inpainting_data import Sheet, fronts
from export.segmentation_data import Sample, Thing
from nostalgin_core.arrays import Gray, Mask, Points
from nostalgin_core.scenes import training
from nostalgin_core.segment import CATEGORIES

SHAPE = (720, 480)  # pixels; a tax photograph's aspect
CLEAR = 0.9  # share of a real front that must be known before another wears it
SEED = 1940


def textures(data: Path) -> list[Gray]:
    """Give the real fronts that nothing hides, straightened; block 993's never.

    What little stands before them is filled from its border.
    """
    sheets = [*fronts(data, "taxphotos"), *fronts(data, "historic_streets")]
    return [clean(s) for s in sheets if not s.held_out and s.known.mean() >= CLEAR]


def clean(sheet: Sheet) -> Gray:
    """Fill what is not known of a front."""
    hidden = (~sheet.known).astype(np.uint8)
    return cv2.inpaint(sheet.image, hidden, 3, cv2.INPAINT_NS).astype(np.uint8)


def rings(mask: Mask) -> tuple[Points, ...]:
    """Give a mask's outlines, those of its holes and pieces included."""
    found, _ = cv2.findContours(
        mask.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE
    )
    return tuple(ring[:, 0].astype(float) for ring in found)


def paint(number: int, wardrobe: list[Gray]) -> tuple[Gray, np.ndarray]:
    """Paint photo `number`: gray, and a layer a thing: category + 1, 0 elsewhere."""
    rng = np.random.default_rng([SEED, number])
    image, things = training.sample(rng, SHAPE, textures=wardrobe)
    return image, np.stack(
        [
            mask * np.uint8(CATEGORIES.index(name) + 1)
            for name, mask, _ in things
            if mask.any()
        ]
    )


def sample(name: str, image: Gray, layers: np.ndarray) -> Sample:
    """Make a labelled photograph of what `paint` gave."""
    things = []
    for layer in layers:
        category = CATEGORIES[int(layer.max()) - 1]
        things.append(Thing(category, rings(layer > 0), int(category != "facade")))
    return Sample(name, image, tuple(things))


def read_painted(folder: Path) -> list[Sample]:
    """Read the photos that were painted into a folder, by number."""
    samples = []
    for path in sorted(folder.glob("painted?????.npz")):
        with np.load(path) as kept:
            samples.append(sample(path.stem, kept["image"], kept["layers"]))
    return samples


def main() -> None:
    """Paint what is not yet in the folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--count", type=int, default=240)
    args = parser.parse_args()
    args.folder.mkdir(parents=True, exist_ok=True)
    wardrobe = textures(args.data)
    for number in range(args.count):
        path = args.folder / f"painted{number:05d}.npz"
        if not path.exists():
            image, layers = paint(number, wardrobe)
            partial = path.with_suffix(".partial.npz")
            np.savez_compressed(partial, image=image, layers=layers)
            partial.replace(path)


if __name__ == "__main__":
    main()
