"""A tax photo is a record of one building; its board and its framing tell which.

The photographer stood in the middle of the street with the building in the middle of
the picture, and the board before it. So a front's *merit* is a logistic function of how
far it lies from the middle of the frame and from the board, how much of the frame it
fills, how sure the network is of it, and whether the frame cuts it. The weights were
fitted to the hand labels of tax blocks 996 and 997.

A corner building shows two fronts. Its second front stands at the first one's side,
meets it at the same height, and the two bend away from the camera: their roof lines
rise, and their feet sink, towards the edge that they share.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Mask
from nostalgin_core.records import Box

WEIGHTS = np.array([0.0, -6.0, -4.0, 2.0, 2.0, -1.0])
"""For 1, distance to the middle, distance to the board, area, score, cut."""


def merits(
    masks: Sequence[Mask],
    scores: Sequence[float],
    frame: Box,
    board: Box | None,
    *,
    weights: Float[np.ndarray, " 6"] = WEIGHTS,
) -> Float[np.ndarray, " n"]:
    """Return for each front how likely it is the one recorded, 0 to 1."""
    rows = [features(m, s, frame, board) for m, s in zip(masks, scores, strict=True)]
    return 1 / (1 + np.exp(-np.array(rows).reshape(-1, 6) @ weights))


def features(
    mask: Mask, score: float, frame: Box, board: Box | None
) -> Float[np.ndarray, " 6"]:
    """Return what the merit weighs: 1, middle, board, area, score, cut.

    Distances run from the front's columns, the inner eight tenths of them, and are
    shares of the frame's width. Without a board the middle stands in for it.
    """
    width, height = frame.x1 - frame.x0, frame.y1 - frame.y0
    columns = np.flatnonzero(mask.any(0))
    weight = mask[:, columns].sum(0).cumsum()
    low, centre, high = columns[np.searchsorted(weight, weight[-1] * SPAN)]
    middle = (frame.x0 + frame.x1) / 2
    aim = middle if board is None else (board.x0 + board.x1) / 2
    far = max(low - aim, aim - high, 0.0) / width
    cut = columns[0] <= frame.x0 + EDGE_PX or columns[-1] >= frame.x1 - EDGE_PX
    area = np.sqrt(mask.sum() / (width * height))
    return np.array([1.0, abs(centre - middle) / width, far, area, score, float(cut)])


SPAN = np.array([0.1, 0.5, 0.9])
EDGE_PX = 4


def corner(left: Mask, right: Mask) -> float:
    """Return how strongly two neighbouring fronts bend away from their shared edge.

    The sum of four slopes in px a px: positive where roofs rise and feet sink towards
    the edge, as at a corner seen from outside; about 0 for two fronts of one street.
    Minus infinity where they do not meet, or at unequal heights.
    """
    a, b = np.flatnonzero(left.any(0)), np.flatnonzero(right.any(0))
    wide = min(len(a), len(b))
    gap = np.percentile(b, 2) - np.percentile(a, 98)
    if wide < 12 or abs(gap) > 0.25 * wide + 6:
        return -np.inf
    at_left, slopes_left = _ends(left, a, near=a[-1])
    at_right, slopes_right = _ends(right, b, near=b[0])
    tall = min(at_left[1] - at_left[0], at_right[1] - at_right[0])
    if tall <= 0 or abs(at_left[0] - at_right[0]) > TOP_MISMATCH * tall:
        return -np.inf
    return float(slopes_right[0] - slopes_left[0] + slopes_left[1] - slopes_right[1])


TOP_MISMATCH = 0.08


def _ends(
    mask: Mask, columns: np.ndarray, *, near: int
) -> tuple[np.ndarray, np.ndarray]:
    """Fit roof and foot; return their heights at column `near` and their slopes."""
    inner = columns[len(columns) // 10 : max(1, len(columns) - len(columns) // 10)]
    tops = np.argmax(mask[:, inner], axis=0)
    feet = mask.shape[0] - 1 - np.argmax(mask[::-1, inner], axis=0)
    heights, slopes = [], []
    for line in (tops, feet):
        half = len(inner) // 2
        run = np.maximum(inner[half:] - inner[: len(inner) - half], 1)
        slope = np.median((line[half:] - line[: len(inner) - half]) / run)
        heights.append(np.median(line - slope * inner) + slope * near)
        slopes.append(slope)
    return np.array(heights), np.array(slopes)
