"""A white arrow stands on the number board, and points at the building that is meant.

It is an upright triangle above the board, near its middle, as high as half the board.
It is sought there by its shape (normalised correlation with a triangle of three sizes);
where nothing looks like one, it is taken to stand where it mostly does.
"""

from typing import Final, NamedTuple

import cv2
import numpy as np

from nostalgin_core.arrays import Gray
from nostalgin_core.records import Box, Photo

USUAL: Final = 0.56  # of the board's width, from the left
ACROSS: Final = (0.36, 0.78)  # of it: where arrows stand
ABOVE: Final = 0.95  # of the board's height, over its upper edge
BELOW: Final = 0.25  # of it, under that: a network's box is a little high
TALL: Final = (0.4, 0.55, 0.7)  # of the board's height
SLENDER: Final = 0.9  # width over height
LEAST: Final = 0.4  # correlation, less the way there, from which a triangle is one
FARTHER: Final = 0.8  # of correlation, that a board's width off the usual place costs
MARGIN_PX: Final = 2  # round a triangle, dark
SMALLEST_PX: Final = 5


class Arrow(NamedTuple):
    """Where a board's arrow stands, and how much it looks like one."""

    x: float  # column in the photo
    y: float  # row of its tip
    sure: float  # correlation, less the way from its usual place; 0: not seen


def arrow(photo: Photo, board: Box) -> Arrow:
    """Find the arrow above a board."""
    width, height = board.x1 - board.x0, board.y1 - board.y0
    usual = Arrow(board.x0 + USUAL * width, board.y0 - height / 2, 0.0)
    x0, x1 = (round(board.x0 + share * width) for share in ACROSS)
    y0, y1 = round(board.y0 - ABOVE * height), round(board.y0 + BELOW * height)
    x0, y0 = max(x0, photo.frame.x0), max(y0, photo.frame.y0)
    part = photo.image[y0 : min(y1, photo.frame.y1), x0 : min(x1, photo.frame.x1)]
    best = usual
    for share in TALL:
        shape = triangle(round(share * height))
        if part.shape[0] < shape.shape[0] or part.shape[1] < shape.shape[1]:
            continue
        likeness = cv2.matchTemplate(part, shape, cv2.TM_CCOEFF_NORMED)
        likeness = np.nan_to_num(likeness)
        middles = x0 + np.arange(likeness.shape[1]) + (shape.shape[1] - 1) / 2
        likeness = likeness - FARTHER * np.abs(middles - usual.x) / max(width, 1)
        row, column = np.unravel_index(int(np.argmax(likeness)), likeness.shape)
        found = float(likeness[row, column])
        if found > max(best.sure, LEAST):
            tip = y0 + float(row) + MARGIN_PX
            best = Arrow(float(middles[column]), tip, min(found, 1.0))
    return best


def triangle(tall_px: int) -> Gray:
    """Paint a white triangle that points up, on dark."""
    tall = max(SMALLEST_PX, tall_px)
    half = max(2, round(SLENDER * tall / 2))
    shape = np.zeros((tall + MARGIN_PX, 2 * (half + MARGIN_PX) + 1), np.uint8)
    tip = [half + MARGIN_PX, MARGIN_PX]
    feet = [
        [MARGIN_PX, tall + MARGIN_PX - 1],
        [2 * half + MARGIN_PX, tall + MARGIN_PX - 1],
    ]
    cv2.fillConvexPoly(shape, np.array([tip, *feet], np.int32), 255)
    return shape
