"""A hand-labelled front becomes a picture seen straight on, and what is known of it.

A labelled quad becomes a rectangle, and what stands before the front is marked as not
known. Training and measuring both cut their fronts here, so that they agree on which
texel is which, and on which files no training may see: all of block 993 (it is tuned
on) and one file in ten of every other folder, chosen by the hash of its name, so that a
new file never moves an old one.
"""

import hashlib
from collections.abc import Iterator, Sequence
from typing import Any

import cv2
import numpy as np
from jaxtyping import Bool, UInt8

from nostalgin_core.arrays import Corners, Gray, Mask
from nostalgin_core.homography import between

Straight = UInt8[np.ndarray, "h2 w2"]
StraightMask = Bool[np.ndarray, "h2 w2"]

SHORTEST_PX = 64  # a front with a shorter side tells nothing about windows
LARGEST_PX = 640
OUTLINE_PX = 3  # labels are good to about this
LEAST_KNOWN = 0.3  # of a front, to be worth looking at
HELD_OUT_BLOCK = "00993"


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
) -> tuple[Straight, StraightMask]:
    """Warp a quad of a photo to a rectangle, with what is known of it."""
    h, w = size_of(quad)
    corners = np.array([[0, 0], [w - 1, 0], [w - 1, h - 1], [0, h - 1]], float)
    front_from_photo = between(quad, corners)
    image = cv2.warpPerspective(photo, front_from_photo, (w, h), flags=cv2.INTER_AREA)
    seen = (own & ~hidden).astype(np.uint8)
    known = cv2.warpPerspective(seen, front_from_photo, (w, h), flags=cv2.INTER_NEAREST)
    return image, known > 0


def straightened(
    photo: Gray, objects: Sequence[dict[str, Any]]
) -> Iterator[tuple[int, Straight, StraightMask]]:
    """Straighten every labelled front of a photo, far rows and slivers left out.

    Yields its number among the label's objects, the front, and what is known of it.
    """
    grow = np.ones((2 * OUTLINE_PX + 1,) * 2, np.uint8)
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
        if known.mean() > LEAST_KNOWN:
            yield number, image, known


def _painted(shape: tuple[int, int], polygons: list[Any]) -> Mask:
    """Fill polygons."""
    canvas = np.zeros(shape, np.uint8)
    for polygon in polygons:
        cv2.fillPoly(canvas, [np.round(polygon).astype(np.int32)], 1)
    return canvas > 0
