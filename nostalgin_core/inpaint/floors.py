"""Deep in a hole the building's own floors go on, and are marked as copied.

Far from all that was seen a fill is a gray smear: in the mean over all fronts that is
nearest to the truth, and nobody would build it. There the storey that looks most like
the one above or below it is repeated, with the tone of the fill. Nothing but holes is
changed, and only on fronts whose rows of windows repeat.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core import evidence
from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.records import Elevation
from nostalgin_core.storeys import COUNTS, EXTRA, flattened, scores

LEAST_SCORE: Final = 0.09  # of a count of storeys: below, nothing repeats
LEAST_SEEN: Final = 0.8  # of the storey that is repeated
LEAST_ALIKE: Final = 0.4  # correlation of that storey with the one beside it
DEEP: Final = 0.8  # storeys: a hole that is less high than this stays as it was filled
WIDE: Final = 0.5
NEARBY: Final = np.linspace(0.94, 1.06, 7)  # of the rows that a count gives
FADE: Final = 0.15  # storeys over which the fill gives way
TONE: Final = 0.4  # storeys: coarser than this, the tone is the fill's

Band = tuple[int, int]  # first row, and rows


def repeated(filled: Elevation) -> Elevation:
    """Repeat a front's best storey wherever a filled elevation's holes are deep."""
    marks = filled.evidence
    hole = (marks == evidence.INPAINTED) | (marks == evidence.BEYOND_FRAME)
    seen = ~hole & (marks != evidence.NOTHING)
    storey = period(filled.image, seen) if hole.any() else None
    if storey is None:
        return filled
    deep = reaching(hole, storey)
    band = best(filled.image, seen, storey) if deep.any() else None
    if band is None:
        return filled
    image, copied = laid(filled.image, deep & source(seen, band), band)
    return replace(
        filled,
        image=image,
        evidence=np.where(copied, np.uint8(evidence.COPIED), marks),
    )


def period(image: Gray, seen: Mask) -> float | None:
    """Tell how many rows a storey has; None where nothing repeats."""
    told = scores(image, seen)
    at = int(np.argmax(told))
    return len(image) / (COUNTS[at] + EXTRA) if told[at] >= LEAST_SCORE else None


def reaching(hole: Mask, storey: float) -> Mask:
    """Take the parts of holes that a piece of a storey fits into, and their rims."""
    wide, high = max(1, round(WIDE * storey)), max(1, round(DEEP * storey))
    padded = np.pad(hole, ((high, high), (wide, wide)), mode="edge").astype(np.uint8)
    piece = np.ones((high, wide), np.uint8)
    opened = cv2.morphologyEx(padded, cv2.MORPH_OPEN, piece)[high:-high, wide:-wide]
    rim = np.ones((2 * round(FADE * storey) + 1,) * 2, np.uint8)
    return (cv2.dilate(opened, rim) > 0) & hole


def best(image: Gray, seen: Mask, storey: float) -> Band | None:
    """Find the storey that most resembles the next one; None if none does.

    The counts of storeys are 4 % apart: how many rows one has is found here as well.
    """
    flat, _ = flattened(image, seen)
    found = [
        (worth, band)
        for rows in np.unique(np.round(storey * NEARBY).astype(int))
        if 1 <= rows <= len(image) // 2
        for worth, band in alike(flat, seen, int(rows))
    ]
    return max(found)[1] if found else None


def alike(
    flat: Float[np.ndarray, "h w"], seen: Mask, rows: int
) -> Iterator[tuple[float, Band]]:
    """Weigh the best storey of so many rows, and the one below that it resembles."""
    both = seen[rows:] & seen[:-rows]

    def summed(values: Float[np.ndarray, "n w"]) -> Float[np.ndarray, " m"]:
        total = np.cumsum(np.concatenate([[0.0], values.sum(axis=1)]))
        return total[rows:] - total[:-rows]

    upper, lower = flat[:-rows] * both, flat[rows:] * both
    power = summed(upper**2) * summed(lower**2)
    correlation = summed(upper * lower) / np.sqrt(np.maximum(power, 1e-9))
    shares = summed(seen.astype(np.float64)) / (rows * seen.shape[1])
    compared = summed(both.astype(np.float64)) / (rows * seen.shape[1])
    for shift in (0, rows):
        share = shares[shift : shift + len(correlation)]
        usable = (share >= LEAST_SEEN) & (correlation >= LEAST_ALIKE)
        worth = np.where(usable, correlation * share * compared, -1.0)
        at = int(np.argmax(worth))
        if usable[at]:
            yield float(worth[at]), (at + shift, rows)


def rows_of(height: int, band: Band) -> np.ndarray:
    """Tell which row of a storey is repeated at each row of the front."""
    first, rows = band
    return first + (np.arange(height) - first) % rows


def source(seen: Mask, band: Band) -> Mask:
    """Tell where what is repeated was seen by a camera."""
    return seen[rows_of(len(seen), band)]


def laid(image: Gray, deep: Mask, band: Band) -> tuple[Gray, Mask]:
    """Lay a storey over the deep parts of holes; tell where it outweighs the fill."""
    rows = band[1]
    pattern = image[rows_of(len(image), band)].astype(np.float32)
    sigma = max(TONE * rows, 1.0)
    fill, own = (cv2.GaussianBlur(one, (0, 0), sigma) for one in (image * 1.0, pattern))
    padded = np.pad(deep, 1, mode="edge").astype(np.uint8)
    away = cv2.distanceTransform(padded, cv2.DIST_L2, 3)[1:-1, 1:-1]
    weight = np.clip(away / max(FADE * rows, 1.0), 0, 1)
    mixed = image + weight * (pattern + fill - own - image)
    out = np.where(deep, np.clip(np.round(mixed), 0, 255), image).astype(np.uint8)
    return out, deep & (weight >= 0.5)
