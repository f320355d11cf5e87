"""Stated uncertainties are held against the truth.

A stated standard deviation `sd` promises that the error stays below 1.96 sd in 95 of
100 cases. The share that it does is the *coverage*; an error over its sd is a
*standardised residual*. For a normal error its size stays below 0.67, 1.64 and 1.96 in
50, 90 and 95 of 100 cases.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

WITHIN = 1.96  # standard deviations either side of the estimate: 95 of 100
QUANTILES = (0.50, 0.68, 0.90, 0.95)


class Coverage(NamedTuple):
    """How often the truth lay in the stated interval."""

    count: int
    share: float
    low: float  # of Wilson's interval for the share
    high: float
    median_width: float  # of the stated interval, in the quantity's own unit
    residuals: tuple[float, ...]  # their sizes at `QUANTILES`


def coverage(
    errors: Float[np.ndarray, " n"], sds: Float[np.ndarray, " n"]
) -> Coverage | None:
    """Hold errors against their stated standard deviations; None where there are none.

    Raises:
        ValueError: if a standard deviation is not above zero.
    """
    if not len(errors):
        return None
    if not np.all(sds > 0):
        raise ValueError(f"standard deviations must be above 0, not {sds.min()}")
    sizes = np.abs(errors) / sds
    inside = int(np.count_nonzero(sizes <= WITHIN))
    low, high = wilson(inside, len(sizes))
    return Coverage(
        len(sizes),
        inside / len(sizes),
        low,
        high,
        2 * WITHIN * float(np.median(sds)),
        tuple(float(q) for q in np.quantile(sizes, QUANTILES)),
    )


def wilson(inside: int, count: int, *, z: float = WITHIN) -> tuple[float, float]:
    """Bound a share that was seen `inside` times in `count` (Wilson 1927).

        (p + z^2 / 2n +- z sqrt(p (1 - p) / n + z^2 / 4n^2)) / (1 + z^2 / n)

    Raises:
        ValueError: unless 0 <= inside <= count and count > 0.
    """
    if not 0 <= inside <= count or count < 1:
        raise ValueError(f"{inside} of {count} is no share")
    p, square = inside / count, z * z
    middle = p + square / (2 * count)
    reach = z * np.sqrt(p * (1 - p) / count + square / (4 * count * count))
    whole = 1 + square / count
    return float((middle - reach) / whole), float((middle + reach) / whole)
