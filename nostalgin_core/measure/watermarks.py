"""A watermark's tile is measured on many copies that bear it, and on what it leaves.

Over the same place of the tile streets differ and the mark does not: J - T = b - a T at
every place, `T` the tone beside the letters (letters as in `rectify.watermark`), so two
sums over all copies tell `a` and `b` by least squares (Dekel et al., CVPR 2017, in
place of whose gradients and matting the known step and tone serve).
"""

from collections.abc import Callable, Iterable
from typing import Final

import cv2
import numpy as np

from nostalgin_core.arrays import Gray
from nostalgin_core.rectify import watermark
from nostalgin_core.rectify.watermark import Sums, Tile, Watermark

ROUNDS: Final = (8.0, 2.5, 2.5, 2.5, 2.5, 2.5)  # px: how near tones are told, by round
LETTERED: Final = 0.02  # of `a`, smoothed: where less is covered, there is no letter
BLUR_CELLS: Final = 3.0
LEAST_SPREAD: Final = 1e-6  # of tones over a place: below, nothing tells `a` from `b`


def measured(
    images: Callable[[], Iterable[Gray]],
    words: str,
    *,
    step: tuple[float, float],
    cells: tuple[int, int],
) -> Watermark:
    """Measure the tile of a mark that images bear, by so many cells down and across.

    Each round tells letters from their background by the round before. The images are
    asked for anew in each round, and are as wide as `watermark.WIDE_PX` at most.
    """
    blank = np.zeros(cells, np.float32)
    mark = Watermark(words, blank, blank, step)
    for near_px in ROUNDS:
        total = Sums(*(np.zeros(cells) for _ in Sums._fields))
        for image in images():
            bare = watermark.background(mark, image.shape)
            own = watermark.summed(image, bare, mark, near_px=near_px)
            total = Sums(*(x + y for x, y in zip(total, own, strict=True)))
        mark = Watermark(words, *solved(total), step)
    return mark


def solved(sums: Sums) -> tuple[Tile, Tile]:
    """Solve for what each place of the tile covers and adds; zero beside letters."""
    spread = sums.w * sums.wtt - sums.wt**2
    known = spread > LEAST_SPREAD * np.maximum(sums.w**2, LEAST_SPREAD)
    spread = np.where(known, spread, 1.0)
    slope = np.where(known, (sums.w * sums.wtr - sums.wt * sums.wr) / spread, 0.0)
    adds = np.where(known, (sums.wr - slope * sums.wt) / np.maximum(sums.w, 1e-9), 0.0)
    smooth = cv2.GaussianBlur(
        np.pad(np.abs(slope), 12, mode="wrap"), (0, 0), BLUR_CELLS
    )
    lettered = smooth[12:-12, 12:-12] > LETTERED
    covers = np.where(lettered, -slope, 0.0)
    return covers.astype(np.float32), np.where(lettered, adds, 0.0).astype(np.float32)
