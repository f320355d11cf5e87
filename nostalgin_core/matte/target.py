"""A tax photo is a record of one building; its board and its framing tell which.

The photographer stood in the middle of the street with the building in the middle of
the picture, and the board before it, whose arrow points at it. So a front's *merit*,
the probability that it is meant, is a logistic function of how far it lies from the
middle of the frame and from the board, how much of the frame it fills, how sure the
network is of it, whether the frame cuts it, and of how many columns near the arrow it
fills more than any other front does. The weights were fitted to the hand labels of tax
blocks 996 and 997, so that what is stated comes true as often (`evaluate segmentation`
tells).

A corner building shows two fronts. Its second front stands at the first one's side,
meets it at the same height, and both roof lines rise towards the edge that they share,
since that edge is what stands nearest to the camera.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Mask
from nostalgin_core.records import Box

WEIGHTS = np.array([-1.03, -3.24, -3.89, -0.08, -0.54, -0.48, 6.44])
"""For 1, distance to the middle, to the board, area, score, cut, over the arrow."""
STRIP = 0.05  # of the frame's width, to either side of the arrow
INNER = np.array([0.1, 0.5, 0.9])  # shares of a front's pixels, from the left
EDGE_PX = 6  # outlines are no better
FEWEST_COLUMNS = 12
WIDEST_GAP = 0.25  # of the narrower front
MISMATCH = 0.12  # of the lower front's height


class Shown(NamedTuple):
    """One front, as far as merit goes."""

    mask: Mask
    whole: Mask  # with what is hidden
    score: float


def merits(
    fronts: Sequence[Shown],
    frame: Box,
    board: Box | None,
    arrow_x: float | None,
    *,
    weights: Float[np.ndarray, " 7"] = WEIGHTS,
) -> Float[np.ndarray, " n"]:
    """Return for each front how likely it is the one recorded, 0 to 1."""
    rows = features(fronts, frame, board, arrow_x)
    return 1 / (1 + np.exp(-rows @ weights))


def features(
    fronts: Sequence[Shown], frame: Box, board: Box | None, arrow_x: float | None
) -> Float[np.ndarray, "n 7"]:
    """Return what the merits weigh, front by front, as `WEIGHTS` tells."""
    over = over_arrow([one.whole for one in fronts], frame, board, arrow_x)
    placed = [where(one.mask, one.score, frame, board) for one in fronts]
    return np.column_stack([np.array(placed).reshape(-1, 6), over])


def over_arrow(
    wholes: Sequence[Mask], frame: Box, board: Box | None, arrow_x: float | None
) -> Float[np.ndarray, " n"]:
    """Return the share of the columns near the arrow that each front fills the most.

    Only what is above the board counts. Without one, the frame's middle is meant.
    """
    width = frame.x1 - frame.x0
    x = (frame.x0 + frame.x1) / 2 if arrow_x is None else arrow_x
    low = int(max(frame.x0, x - STRIP * width))
    high = int(min(frame.x1, x + STRIP * width + 1))
    foot = frame.y1 if board is None else board.y0
    if high <= low or not len(wholes):
        return np.zeros(len(wholes))
    counts = np.array([whole[:foot, low:high].sum(axis=0) for whole in wholes])
    first = np.argmax(counts, axis=0)
    told = counts.max(axis=0) > 0
    return np.bincount(first[told], minlength=len(wholes)) / (high - low)


def where(
    mask: Mask, score: float, frame: Box, board: Box | None
) -> Float[np.ndarray, " 6"]:
    """Return the merit's first six: 1, middle, board, area, score, cut.

    Distances run from the front's columns, the inner eight tenths of them, and are
    shares of the frame's width. Without a board the middle stands in for it.
    """
    width, height = frame.x1 - frame.x0, frame.y1 - frame.y0
    columns = np.flatnonzero(mask.any(0))
    weight = mask[:, columns].sum(0).cumsum()
    low, centre, high = columns[np.searchsorted(weight, weight[-1] * INNER)]
    middle = (frame.x0 + frame.x1) / 2
    aim = middle if board is None else (board.x0 + board.x1) / 2
    far = max(low - aim, aim - high, 0.0) / width
    cut = columns[0] <= frame.x0 + EDGE_PX or columns[-1] >= frame.x1 - EDGE_PX
    area = np.sqrt(mask.sum() / (width * height))
    return np.array([1.0, abs(centre - middle) / width, far, area, score, float(cut)])


def corner(left: Mask, right: Mask) -> float:
    """Return how steeply two neighbouring fronts' roofs rise to their shared edge.

    The lesser of the two slopes, in px a px: positive only where both rise, as at a
    corner seen from outside; fronts of one street rise and fall together. Feet would
    sink there, but cars hide them. Minus infinity where the two do not meet, or at
    unequal heights.
    """
    a, b = np.flatnonzero(left.any(0)), np.flatnonzero(right.any(0))
    narrow = min(len(a), len(b))
    if narrow < FEWEST_COLUMNS:
        return -np.inf
    gap = np.percentile(b, 2) - np.percentile(a, 98)
    if abs(gap) > WIDEST_GAP * narrow + EDGE_PX:
        return -np.inf
    roof_left, foot_left, rise_left = _edge(left, a, near=int(a[-1]))
    roof_right, foot_right, rise_right = _edge(right, b, near=int(b[0]))
    tall = min(foot_left - roof_left, foot_right - roof_right)
    if tall <= 0 or abs(roof_left - roof_right) > MISMATCH * tall:
        return -np.inf
    return min(-rise_left, rise_right)


def _edge(mask: Mask, columns: np.ndarray, *, near: int) -> tuple[float, float, float]:
    """Return where roof and foot meet column `near`, and the roof line's slope.

    Lines are fitted to the inner eight tenths of the columns: slopes between the two
    halves, then their median.
    """
    margin = len(columns) // 10
    inner = columns[margin : len(columns) - margin]
    roofs = np.argmax(mask[:, inner], axis=0)
    feet = mask.shape[0] - 1 - np.argmax(mask[::-1, inner], axis=0)
    half = len(inner) // 2
    run = inner[half:] - inner[: len(inner) - half]
    ends, slopes = [], []
    for line in (roofs, feet):
        slope = float(np.median((line[half:] - line[: len(inner) - half]) / run))
        slopes.append(slope)
        ends.append(float(np.median(line + slope * (near - inner))))
    return ends[0], ends[1], slopes[0]
