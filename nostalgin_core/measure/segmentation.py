"""Masks are compared with hand-drawn ones as the paper's table 1 does.

For a soft prediction p, a truth t (0 or 1) and a threshold, over the pixels that count:
precision and recall of p > threshold, l1 = mean |p - t|, l2 = mean (p - t)^2, the last
two in hundredths. Where nothing is true and nothing is claimed, precision and recall
are 1. Paper, section 4.1 and appendix.
"""

from typing import NamedTuple

import numpy as np

from nostalgin_core.arrays import Mask, Probability


class Agreement(NamedTuple):
    """How well one photo's fronts were found."""

    precision: float
    recall: float
    l1: float
    l2: float


def agreement(
    predicted: Probability, true: Mask, counted: Mask, *, threshold: float
) -> Agreement:
    """Compare a soft mask with the truth.

    The paper's threshold is 0.5 for the network's masks and 0.1 for mattes.
    """
    claimed = (predicted > threshold) & counted
    hits = np.count_nonzero(claimed & true)
    off = np.abs(predicted - true)[counted]
    if not claimed.any() and not true.any():
        precision = recall = 1.0
    else:
        precision = hits / max(1, np.count_nonzero(claimed))
        recall = hits / max(1, np.count_nonzero(true))
    return Agreement(
        precision, recall, float(off.mean() * 100), float((off**2).mean() * 100)
    )


def overlap(a: Mask, b: Mask) -> float:
    """Return the intersection over the union, 0 where both are empty."""
    union = np.count_nonzero(a | b)
    return np.count_nonzero(a & b) / union if union else 0.0
