"""Several prints on one page are no photograph of one street: they are to be cut apart.

Between two prints a *gutter* shows: a stripe of the page, of one tone along its whole
length, that ends on either side at a straight edge where the pictures begin. No street
has such a stripe through its middle: sky and roads are even too, but end in no straight
line from side to side.
"""

from collections.abc import Iterator
from typing import Final

import cv2
import numpy as np

from nostalgin_core.arrays import Gray

SIDE_PX: Final = 400  # of the longer side: gutters stay, grain goes
SPANS: Final = ((0.02, 0.98), (0.02, 0.64), (0.36, 0.98))  # captions stand beside
EVEN: Final = 14.0  # gray levels between a stripe's darkest and lightest twentieth
STEP: Final = 20.0  # gray levels between a stripe and what begins beside it
BEGINS: Final = 0.6  # of the stripe's length
REACHES: Final = 0.92  # of the page's length: captions are sparse
OUTER: Final = 0.12  # of the page, where margins are
PAPER: Final = 72.0  # gray level from which a page is one: bars and posts are darker
THIN: Final = 0.008  # of the page
EDGE_PX: Final = 3


def gutters(image: Gray) -> int:
    """Count the stripes of page between prints, one above or beside another."""
    scale = min(1.0, SIDE_PX / max(image.shape))
    size = [max(8, round(side * scale)) for side in image.shape[::-1]]
    small = cv2.resize(image, size, interpolation=cv2.INTER_AREA).astype(np.float32)
    smooth = cv2.GaussianBlur(small, (3, 3), 0)
    return max(
        sum(
            _reaches(lines, *stripe)
            for stripe in _stripes(lines[:, slice(*_cut(lines, span))])
        )
        for lines in (smooth, smooth.T)
        for span in SPANS
    )


def _reaches(lines: np.ndarray, begin: int, end: int) -> bool:
    """Tell whether a stripe goes on to both ends of the page, but for what is written.

    The sky between two houses ends at the ground.
    """
    whole = np.median(lines[begin:end, slice(*_cut(lines, SPANS[0]))], axis=0)
    near = np.abs(whole - np.median(whole)) < EVEN
    return bool(near.mean() >= REACHES)


def _cut(lines: np.ndarray, span: tuple[float, float]) -> tuple[int, int]:
    length = lines.shape[1]
    return round(span[0] * length), round(span[1] * length)


def _stripes(lines: np.ndarray) -> Iterator[tuple[int, int]]:
    """Yield the first line of each gutter and the one after its last."""
    count = len(lines)
    low, high = np.percentile(lines, (5, 95), axis=1)
    even = np.concatenate([[False], high - low < EVEN, [False]])
    turns = np.flatnonzero(even[1:] != even[:-1])
    for begin, end in zip(turns[::2], turns[1::2], strict=True):
        inner = begin > OUTER * count and end < (1 - OUTER) * count
        if not inner or end - begin < max(2, THIN * count):
            continue
        tone = np.median(lines[begin:end], axis=0)
        if np.median(tone) < PAPER:
            continue
        above, below = lines[begin - EDGE_PX], lines[end - 1 + EDGE_PX]
        if all((np.abs(x - tone) > STEP).mean() >= BEGINS for x in (above, below)):
            yield int(begin), int(end)
