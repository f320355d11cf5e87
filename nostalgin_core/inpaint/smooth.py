"""A smooth fill of a hole: what the inpainter starts from where nothing repeats.

The fill solves Laplace's equation inside the hole, with the known texels as its
border: the membrane that is stretched over it. It is found coarse to fine ("push and
pull"), with a few sweeps of Jacobi's method on each level, in time linear in the area.
"""

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Mask

FLOW_PX = 3  # as far as the fluid's law looks (the paper's radius for Navier-Stokes)
SWEEPS = 6  # a level: the coarser ones have done the far-reaching part

Values = Float[np.ndarray, "h w"]
Half = Float[np.ndarray, "h2 w2"]

_CROSS = np.array([[0, 1, 0], [1, 0, 1], [0, 1, 0]], np.float32) / 4


def _halved(values: Values, weights: Values) -> tuple[Half, Half]:
    """Average two by two texels, by weight; an odd last row or column is repeated."""
    h, w = values.shape
    pad = ((0, h % 2), (0, w % 2))
    sums = [
        np.pad(a, pad, mode="edge").reshape((h + 1) // 2, 2, -1, 2).mean((1, 3))
        for a in (values * weights, weights)
    ]
    total = np.maximum(sums[1], 1e-6)
    return sums[0] / total, (sums[1] > 0).astype(np.float32)


def fill(values: Values, hole: Mask) -> Values:
    """Stretch a membrane over the hole; what is known stays as it is.

    A hole that covers everything is filled with zeros.
    """
    values = np.where(hole, 0, values).astype(np.float32)
    known = (~hole).astype(np.float32)
    if not hole.any():
        return values
    if known.any() and min(values.shape) > 1:
        coarse, weights = _halved(values, known)
        coarse = fill(coarse, weights == 0)
        h, w = values.shape
        wide = cv2.resize(
            coarse,
            (2 * coarse.shape[1], 2 * coarse.shape[0]),
            interpolation=cv2.INTER_LINEAR,
        )[:h, :w]
    else:
        wide = np.full_like(values, values.sum() / max(known.sum(), 1))
    made = np.where(hole, wide, values)
    for _ in range(SWEEPS):
        relaxed = cv2.filter2D(made, -1, _CROSS, borderType=cv2.BORDER_REFLECT)
        made = np.where(hole, relaxed, values)
    return made


def flow(values: Values, hole: Mask) -> Values:
    """Fill half as a membrane, half as a fluid that carries edges on into the hole.

    The two err differently, so that their mean is nearer to the truth than either. The
    fluid is Navier and Stokes's (Bertalmio et al., "Navier-Stokes, Fluid Dynamics, and
    Image and Video Inpainting").
    """
    made = fill(values, hole)
    if not hole.any() or hole.all():
        return made
    carried = cv2.inpaint(made, hole.astype(np.uint8), FLOW_PX, cv2.INPAINT_NS)
    return np.where(hole, (made + carried) / 2, made)
