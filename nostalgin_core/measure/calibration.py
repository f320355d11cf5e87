"""Stated probabilities are held against how often they came true.

Events are sorted into bins by what was stated of them; a calibrated forecaster's share
that came true is the mean that was stated, bin by bin (DeGroot and Fienberg, "The
Comparison and Evaluation of Forecasters", 1983). The *Brier score* is the mean of
(stated - true)^2; the *calibration error* is the mean over all events of
|stated - share| of their bin (Naeini et al., 2015).
"""

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

EDGES: Final = (0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0)


class Bin(NamedTuple):
    """What was stated from `low` to `high`, the latter left to the next bin."""

    low: float
    high: float
    count: int
    stated: float  # mean
    share: float  # that came true


class Reliability(NamedTuple):
    """How far stated probabilities can be trusted."""

    bins: tuple[Bin, ...]  # none is empty
    brier: float
    error: float


def reliability(
    stated: Sequence[float],
    came_true: Sequence[bool],
    *,
    edges: Sequence[float] = EDGES,
) -> Reliability | None:
    """Sort events into bins; None where there are none.

    Raises:
        ValueError: if something stated is no probability.
    """
    p, true = np.asarray(stated, float), np.asarray(came_true, bool)
    if not len(p):
        return None
    if not np.all((p >= 0) & (p <= 1)):
        raise ValueError(f"probabilities run from 0 to 1, not {p.min()} to {p.max()}")
    place = np.minimum(np.searchsorted(edges, p, side="right") - 1, len(edges) - 2)
    bins = tuple(
        Bin(
            float(edges[i]),
            float(edges[i + 1]),
            int(np.count_nonzero(place == i)),
            float(p[place == i].mean()),
            float(true[place == i].mean()),
        )
        for i in np.unique(place)
    )
    error = sum(b.count * abs(b.stated - b.share) for b in bins) / len(p)
    return Reliability(bins, float(np.mean((p - true) ** 2)), float(error))
