"""A watermark's tile is measured on many copies that bear it, and on what it leaves.

Over the same place of the tile streets differ and the mark does not: J - T = b - a T at
every place, `T` the tone beside the letters (letters as in `rectify.watermark`), so two
sums over all copies tell `a` and `b` by least squares (Dekel et al., CVPR 2017, in
place of whose gradients and matting the known step and tone serve).
"""

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Final

import cv2
import numpy as np

from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.rectify import watermark
from nostalgin_core.rectify.watermark import (
    NEAR_PX,
    WHITE,
    WIDE_PX,
    Sums,
    Tile,
    Watermark,
)

ROUNDS: Final = 6
FIRST_PX: Final = 8.0  # how near tones are told before letters are known
HALO: Final = (0.1, 0.03)  # in first rounds: what letters' own tone puts round them
NOISE: Final = 2.5  # times what the tile's median place stands out: letters do more
PEAK: Final = 99.5  # per cent of places, below what stands out most
LEAST_WEIGHT: Final = 0.05  # of a place: one pixel on an even wall
MOST: Final = 0.9  # of `a`: behind what covers more there is nothing to solve for
BLUR_CELLS: Final = 2.0
STROKE: Final = 0.5  # of the way from a stroke's middle to what lies beside it
LEAST_SPREAD: Final = 1e-6  # of tones over a place: below, nothing tells `a` from `b`


def measured(images: Callable[[], Iterable[Gray]], mark: Watermark) -> Watermark:
    """Measure the tile of a mark that images bear: what was known of it is not.

    Each round tells letters from their background by the round before. The images are
    asked for anew in each round, and are `wide_px` wide at most.
    """
    blank = np.zeros(mark.covers.shape, np.float32)
    mark = replace(mark, covers=blank, adds=blank, near_px=FIRST_PX)
    for number in range(ROUNDS):
        total = Sums(*(np.zeros(blank.shape) for _ in Sums._fields))
        for image in images():
            bare = watermark.background(mark, image.shape)
            own = watermark.summed(image, bare, mark)
            total = Sums(*(x + y for x, y in zip(total, own, strict=True)))
        halo = HALO[number] if number < len(HALO) else 0.0
        covers, adds = solved(total, halo)
        mark = replace(mark, covers=covers, adds=adds)
        mark = replace(mark, near_px=near(mark))
    return mark


def near(mark: Watermark) -> float:
    """Tell how near to strokes their background's tone is told: wide ones reach far."""
    lettered = np.pad((mark.covers != 0) | (mark.adds != 0), 2, mode="wrap")
    far = cv2.distanceTransform(lettered.astype(np.uint8), cv2.DIST_L2, 3).max()
    cell_px = mark.step[0] * WIDE_PX / mark.covers.shape[1]
    return max(NEAR_PX, STROKE * float(far) * cell_px)


def solved(sums: Sums, halo: float) -> tuple[Tile, Tile]:
    """Solve for what each place of the tile covers and adds; zero beside letters."""
    spread = sums.w * sums.wtt - sums.wt**2
    enough = np.maximum(sums.w**2, LEAST_SPREAD)
    known = (spread > LEAST_SPREAD * enough) & (sums.w > LEAST_WEIGHT)
    over = np.where(known, sums.w * sums.wtr - sums.wt * sums.wr, 0.0)
    slope = np.clip(over / np.where(known, spread, 1.0), -MOST, MOST)
    adds = (sums.wr - slope * sums.wt) / np.maximum(sums.w, LEAST_WEIGHT)
    lettered = known & borne(sums, slope, spread, halo)
    covers, adds = (np.where(lettered, one, 0.0) for one in (-slope, adds))
    return covers.astype(np.float32), adds.clip(-WHITE, WHITE).astype(np.float32)


def borne(sums: Sums, slope: Tile, spread: Tile, halo: float) -> Mask:
    """Tell which places stand out, in the mean or with the tone, more than by chance.

    In squares of standard deviations, as weights are one over variances; what most
    places have is chance, and so is a `halo`, a share of what stands out most.
    """
    chance = sums.wr**2 / np.maximum(sums.w, 1e-9)
    chance += slope**2 * spread / np.maximum(sums.w, 1e-9)
    padded = np.pad(chance, 12, mode="wrap")
    smooth = cv2.GaussianBlur(padded, (0, 0), BLUR_CELLS)[12:-12, 12:-12]
    low, high = np.median(smooth), np.percentile(smooth, PEAK)
    return smooth > max(NOISE * float(low), halo * float(high))
