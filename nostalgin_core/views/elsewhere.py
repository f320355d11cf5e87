"""How much better two elevations fit where they were laid than anywhere else.

Windows repeat, so that the fronts of a row fit each other at every bay. What a front
alone has fits in one place. Both are correlated at all shifts at once, on what a camera
saw in both (masked correlation by Fourier transforms; Padfield, 2012).
"""

from typing import Final

import numpy as np
from jaxtyping import Bool, Float
from scipy import fft

LONGEST_PX: Final = 160
NEAR: Final = 0.04  # of the longest: so far off, the place is the same
SHARED: Final = 0.4  # of what the lesser of both shows: less in common tells nothing
FEWEST: Final = 100  # texels
LEAST: Final = 1e-3

Picture = Float[np.ndarray, "h w"]
Seen = Bool[np.ndarray, "h w"]


def margin(a: Picture, b: Picture, seen_a: Seen, seen_b: Seen) -> float:
    """Tell by how much two pictures correlate better as they lie than shifted.

    Returns -2 to 2; 0 where they have too little in common.
    """
    if min(seen_a.sum(), seen_b.sum()) < FEWEST:
        return 0.0
    at = correlations(a, b, seen_a, seen_b)
    h, w = at.shape
    y, x = np.arange(h), np.arange(w)
    shift = np.hypot(np.minimum(y, h - y)[:, None], np.minimum(x, w - x)[None])
    far = shift > NEAR * max(a.shape)
    here, there = at[~far].max(), at[far].max()
    return float(here - there) if min(here, there) > -1 else 0.0


def correlations(
    a: Picture, b: Picture, seen_a: Seen, seen_b: Seen
) -> Float[np.ndarray, "y x"]:
    """Correlate two pictures at all shifts; -1 where they have too little in common."""
    shape = [fft.next_fast_len(2 * side, real=True) for side in a.shape]
    a = np.where(seen_a, a - a[seen_a].mean(), 0.0).astype(np.float32)
    b = np.where(seen_b, b - b[seen_b].mean(), 0.0).astype(np.float32)
    ma, mb = seen_a.astype(np.float32), seen_b.astype(np.float32)
    every = np.stack([a, ma, a * a, b, mb, b * b])
    one, known_one, squares_one, two, known_two, squares_two = np.asarray(
        fft.rfft2(every, shape)
    )
    over = np.stack(
        [
            one.conj() * two,
            known_one.conj() * known_two,
            squares_one.conj() * known_two,
            known_one.conj() * squares_two,
        ]
    )
    product, common, power_a, power_b = np.asarray(fft.irfft2(over, shape))
    at = product / np.sqrt(np.maximum(power_a * power_b, LEAST))
    few = max(FEWEST, SHARED * min(seen_a.sum(), seen_b.sum()))
    return np.where(common < few - 0.5, -1.0, np.clip(at, -1, 1))
