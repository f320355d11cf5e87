"""A good guess of alpha is brought down to less cost by conjugate gradients.

Solved at half the size and brought up, alpha is right but for what the coarse grid
can't show. That part is local, and conjugate gradients, preconditioned by the diagonal,
need few steps to mend it (Hestenes and Stiefel 1952; from a coarser grid's solution it
is Bornemann and Deuflhard's cascadic multigrid, 1996).
"""

import numpy as np
from jaxtyping import Float32

from nostalgin_core.matte.windows import Windows

_Pixels = Float32[np.ndarray, " p"]


def descend(
    windows: Windows,
    start: _Pixels,
    *,
    belief: _Pixels | None = None,
    weight: float = 0.0,
    steps: int,
    settled: float,
) -> _Pixels:
    """Lessen alpha' L alpha + weight |alpha - belief|^2, the known pixels held fixed.

    Args:
        windows: Of the unknown pixels.
        start: A guess; the known pixels' alpha.
        belief: What alpha probably is.
        weight: How strongly, against a diagonal of order 1.
        steps: At most so many.
        settled: Where no pixel moves by more, it ends.
    """
    hold = np.float32(weight) * windows.unknown
    down = -windows.residual(start)
    if belief is not None:
        down += hold * (belief - start)
    # A pixel in even windows alone has next to no diagonal; a start of 0 is kept there.
    scale = windows.unknown / np.maximum(windows.diagonal + hold, np.float32(1e-6))
    alpha, along = start, np.zeros_like(start)
    before = 0.0
    for _ in range(steps):
        scaled = scale * down
        now = float(down @ scaled)
        along = scaled + np.float32(now / before if before else 0.0) * along
        bent = windows.residual(along) + hold * along
        curvature = float(along @ bent)
        if curvature <= 0:  # nothing is left but rounding
            break
        move = np.float32(now / curvature) * along
        alpha = alpha + move
        if np.abs(move).max() < settled:
            break
        down = down - np.float32(now / curvature) * bent
        before = now
    return alpha
