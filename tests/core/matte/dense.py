"""Small matting systems written out in full, and pictures of noise to make them of."""

import numpy as np
from scipy import sparse

from nostalgin_core.matte.laplacian import System


def whole(system: System) -> np.ndarray:
    """Write the symmetric matrix of a system's upper half."""
    n = len(system.right)
    there = system.neighbours >= 0
    rows = np.broadcast_to(np.arange(n), there.shape)[there]
    upper = sparse.coo_array(
        (system.values[there], (rows, system.neighbours[there])), shape=(n, n)
    ).toarray()
    return upper + np.triu(upper, 1).T


def noise(h: int, w: int, seed: int = 0) -> np.ndarray:
    """Paint light between 0 and 1 that no two windows share."""
    return np.random.default_rng(seed).random((h, w))
