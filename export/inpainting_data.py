"""What the inpainter learns from: fronts of the time, straightened, and other facades.

A labelled quad becomes a rectangle, and what stands before the front is marked as not
known: the network sees it as part of the hole, and the loss leaves it out, so that no
person is ever painted into a wall. Photographs without labels are known everywhere.

Held out are all of block 993 (it is tuned on) and one file in ten of every other
folder, chosen by the hash of its name, so that a new file never moves an old one.
Painted fronts are never asked about, so none is held out.
"""

import hashlib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import cv2
import numpy as np

from nostalgin_core.arrays import Corners, Gray, Mask
from nostalgin_core.homography import between
from nostalgin_core.scenes import training

SHORTEST_PX = 64  # a front with a shorter side teaches nothing about windows
LARGEST_PX = 640
OUTLINE_PX = 3  # labels are good to about this
HELD_OUT_BLOCK = "00993"
LABELLED = ("taxphotos", "historic_streets")
PLAIN = (
    "historic_streets/photos",
    "street_facades_cc0",
    "rectified_facades",
    "facades_coco/train",
)


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


def held_out(folder: str, stem: str) -> bool:
    """Tell whether a file is kept from training: block 993, and one in ten by name."""
    if folder == "taxphotos" and stem.startswith(HELD_OUT_BLOCK):
        return True
    return hashlib.sha256(f"{folder}/{stem}".encode()).digest()[0] % 10 == 0


def size_of(quad: Corners) -> tuple[int, int]:
    """Give a straightened front the mean lengths of its quad's sides: (h, w)."""
    sides = np.linalg.norm(quad - np.roll(quad, -1, axis=0), axis=1)
    across, down = (sides[0] + sides[2]) / 2, (sides[1] + sides[3]) / 2
    shrink = min(1.0, LARGEST_PX / max(across, down))
    return round(down * shrink), round(across * shrink)


def straighten(
    photo: Gray, quad: Corners, own: Mask, hidden: Mask
) -> tuple[Gray, Mask]:
    """Warp a quad of a photo to a rectangle, with what is known of it."""
    h, w = size_of(quad)
    corners = np.array([[0, 0], [w - 1, 0], [w - 1, h - 1], [0, h - 1]], float)
    front_from_photo = between(quad, corners)
    image = cv2.warpPerspective(photo, front_from_photo, (w, h), flags=cv2.INTER_AREA)
    seen = (own & ~hidden).astype(np.uint8)
    known = cv2.warpPerspective(seen, front_from_photo, (w, h), flags=cv2.INTER_NEAREST)
    return image, known > 0


def _painted(shape: tuple[int, int], polygons: list[list[list[float]]]) -> Mask:
    """Fill polygons."""
    canvas = np.zeros(shape, np.uint8)
    for polygon in polygons:
        cv2.fillPoly(canvas, [np.round(polygon).astype(np.int32)], 1)
    return canvas > 0


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
    grow = np.ones((2 * OUTLINE_PX + 1,) * 2, np.uint8)
    for path in sorted((data / folder / "labels").glob("*.json")):
        # A tax photograph's file name begins with the archive's own prefix.
        (file,) = (data / folder / "photos").glob(f"*{path.stem}.jpg")
        photo = read(file)
        objects = json.loads(path.read_text())["objects"]
        others = [o["polygon"] for o in objects if o["category"] != "facade"]
        hidden = cv2.dilate(_painted(photo.shape, others).astype(np.uint8), grow) > 0
        for number, thing in enumerate(objects):
            if thing["category"] != "facade" or thing.get("group"):
                continue
            quad = np.array(thing["quad"], float)
            if min(size_of(quad)) < SHORTEST_PX:
                continue
            own = _painted(photo.shape, [thing["polygon"]])
            image, known = straighten(photo, quad, own, hidden)
            if known.mean() > 0.3:
                name = f"{folder}/{path.stem}/{number}"
                yield Sheet(
                    name, image, known, held_out(folder, path.stem), kind="front"
                )


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
