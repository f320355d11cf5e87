"""What the inpainter learns from: fronts of the time, straightened, and other facades.

A labelled quad becomes a rectangle, and what stands before the front is marked as not
known: the network sees it as part of the hole, and the loss leaves it out, so that no
person is ever painted into a wall. Photographs without labels are known everywhere.

Held out are all of block 993 (it is tuned on) and one file in ten of every other
folder, chosen by the hash of its name, so that a new file never moves an old one.
Painted fronts are never asked about, so none is held out.
"""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import cv2
import numpy as np

from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.measure.labelled_fronts import (
    LARGEST_PX,
    held_out,
    size_of,
    straighten,
    straightened,
)
from nostalgin_core.scenes import training

LABELLED = ("taxphotos", "historic_streets")
PLAIN = (
    "historic_streets/photos",
    "street_facades_cc0",
    "rectified_facades",
    "facades_coco/train",
)
__all__ = [
    "Kind",
    "Sheet",
    "fronts",
    "held_out",
    "painted",
    "plain",
    "read",
    "sheets",
    "size_of",
    "straighten",
]


# A front is straightened from a labelled quad; a plain picture is as it was taken.
Kind = Literal["front", "painted", "plain"]


@dataclass(frozen=True, slots=True, eq=False)
class Sheet:
    """One picture to learn from."""

    name: str  # folder and file, and the object's number in its labels
    image: Gray
    known: Mask  # what a camera saw of the front itself
    held_out: bool
    kind: Kind


def read(path: Path) -> Gray:
    """Read a photograph in gray.

    Raises:
        ValueError: if it is none.
    """
    image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    if image is None:
        raise ValueError(f"{path} is no picture")
    return image.astype(np.uint8, copy=False)


def fronts(data: Path, folder: str) -> Iterator[Sheet]:
    """Straighten every labelled front of a folder, far rows and slivers left out."""
    for path in sorted((data / folder / "labels").glob("*.json")):
        # A tax photograph's file name begins with the archive's own prefix.
        (file,) = (data / folder / "photos").glob(f"*{path.stem}.jpg")
        objects = json.loads(path.read_text())["objects"]
        kept = held_out(folder, path.stem)
        for number, image, known in straightened(read(file), objects):
            name = f"{folder}/{path.stem}/{number}"
            yield Sheet(name, image, known, kept, kind="front")


def plain(data: Path, folder: str) -> Iterator[Sheet]:
    """Read photographs as they are, in gray, at most `LARGEST_PX` long."""
    for path in sorted((data / folder).glob("*.jpg")):
        image = read(path)
        shrink = min(1.0, LARGEST_PX / max(image.shape))
        if shrink < 1.0:
            image = cv2.resize(
                image, None, fx=shrink, fy=shrink, interpolation=cv2.INTER_AREA
            )
        kept = held_out(folder.partition("/")[0], path.stem)
        known = np.broadcast_to(np.True_, image.shape)
        yield Sheet(f"{folder}/{path.stem}", image, known, kept, kind="plain")


def painted() -> Iterator[Sheet]:
    """Give the fronts that painted streets share: whole, clean and known everywhere."""
    for number in range(training.POOL):
        image = training.pooled(number)
        known = np.broadcast_to(np.True_, image.shape)
        yield Sheet(f"painted/{number}", image, known, held_out=False, kind="painted")


def sheets(data: Path) -> tuple[Sheet, ...]:
    """Read everything there is to learn from, in an order that never changes."""
    labelled = (sheet for folder in LABELLED for sheet in fronts(data, folder))
    others = (sheet for folder in PLAIN for sheet in plain(data, folder))
    return (*labelled, *others, *painted())
