"""Closed-form matting solves for alpha on the unknown band alone, coarse to fine.

The alpha of least cost under the matting Laplacian, with the trimap's known pixels held
fixed (Levin, Lischinski and Weiss, PAMI 2008, equation 13, with lambda infinite). A
small band is solved exactly. A large one is solved at half the size first, as in
Levin's published program, and mended at full size by conjugate gradients.
"""

from typing import Final

import cv2
import numpy as np
from jaxtyping import Float, Float32

from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.matte import banded, laplacian
from nostalgin_core.matte.descent import descend
from nostalgin_core.matte.laplacian import EPSILON, PAD, Belief
from nostalgin_core.matte.trimap import BACKGROUND, FOREGROUND, UNKNOWN, Trimap
from nostalgin_core.matte.windows import windows

DIRECT: Final = 20_000  # unknowns, solved at once in some tenths of a second
STEPS: Final = 24  # half of them cost 6 % in squared error, twice as many save 2 %
BELIEVING_STEPS: Final = 16  # a belief ties pixels down one by one: fewer will do
SETTLED: Final = 4e-3  # a step of 8 bits
FIRM: Final = 1e-3  # a belief's weight from which float32 holds the factor

_Light = Float32[np.ndarray, "h w"]


def alpha(
    image: Gray,
    trimap: Trimap,
    *,
    prior: Belief | None = None,
    epsilon: float = EPSILON,
    direct: int = DIRECT,
) -> _Light:
    """Find the alpha of least cost that agrees with the trimap where it is known.

    A band of `direct` unknown pixels or more is solved at half the size first. There,
    alpha is brought to full size by its own local affine model, and what that misses is
    mended: memory grows with the band, not with the square of its width.

    Args:
        image: What the camera saw.
        trimap: Codes of `trimap`.
        prior: What to believe where the image does not tell.
        epsilon: n times the variance below which a window counts as even; white is 1.
        direct: How many unknown pixels are too many to be solved at once.

    Raises:
        ValueError: if the trimap knows no pixel at all.
    """
    unknown = (trimap != BACKGROUND) & (trimap != FOREGROUND)
    if unknown.all():
        message = f"a trimap of {trimap.shape} without a known pixel"
        raise ValueError(message)
    result = (trimap == FOREGROUND).astype(np.float32)
    if not unknown.any():
        return result
    y, x = (np.flatnonzero(unknown.any(axis=axis)) for axis in (1, 0))
    part = tuple(slice(max(0, a[0] - PAD), a[-1] + PAD + 1) for a in (y, x))
    light = image[part].astype(np.float32) / np.float32(255.0)
    here = prior and Belief(prior.alpha[part].astype(np.float32), prior.weight)
    solved = _solve(light, trimap[part], here, epsilon, direct)
    result[part] = np.clip(solved, 0.0, 1.0)
    return result


def _solve(
    light: _Light, trimap: Trimap, prior: Belief | None, epsilon: float, direct: int
) -> _Light:
    unknown = (trimap != BACKGROUND) & (trimap != FOREGROUND)
    result = (trimap == FOREGROUND).astype(np.float32)
    if np.count_nonzero(unknown) < direct:
        result[unknown] = _exactly(light, unknown, result, prior, epsilon)
    else:
        result[unknown] = _from_half(light, trimap, prior, epsilon, direct)
        _mend(light, unknown, result, prior, epsilon)
    return result


def _exactly(
    light: _Light, unknown: Mask, known: _Light, prior: Belief | None, epsilon: float
) -> Float[np.ndarray, " n"]:
    """Solve for all unknown pixels at once."""
    equations = laplacian.system(light, unknown, known, prior=prior, epsilon=epsilon)
    # A belief keeps the matrix far from singular: rounding then costs 1e-4 at most.
    precise = prior is None or prior.weight < FIRM
    return banded.solve(equations, banded.order(unknown), precise=precise)


def _mend(
    light: _Light, unknown: Mask, matte: _Light, prior: Belief | None, epsilon: float
) -> None:
    """Mend in place what half the size could not show."""
    held = windows(light, unknown, epsilon=epsilon)
    flat = matte.reshape(-1)
    flat[held.places] = descend(
        held,
        flat[held.places],
        belief=None if prior is None else prior.alpha.ravel()[held.places],
        weight=0.0 if prior is None else prior.weight,
        steps=STEPS if prior is None else BELIEVING_STEPS,
        settled=SETTLED,
    )


def _from_half(
    light: _Light, trimap: Trimap, prior: Belief | None, epsilon: float, direct: int
) -> Float32[np.ndarray, " n"]:
    """Solve at half the size; guess the unknown alpha by its affine model of the image.

    This is the coarse-to-fine scheme of Levin's published program. What is believed of
    a pixel there is believed of four.
    """
    unknown = (trimap != BACKGROUND) & (trimap != FOREGROUND)
    h, w = light.shape
    half = ((w + 1) // 2, (h + 1) // 2)

    def down(array: np.ndarray) -> np.ndarray:
        even = cv2.copyMakeBorder(array, 0, h % 2, 0, w % 2, cv2.BORDER_REPLICATE)
        return cv2.resize(even, half, interpolation=cv2.INTER_AREA)

    small = np.full(half[::-1], UNKNOWN, np.uint8)
    small[down((trimap == FOREGROUND).astype(np.float32)) >= 1.0] = FOREGROUND
    small[down((trimap == BACKGROUND).astype(np.float32)) >= 1.0] = BACKGROUND
    if (small == UNKNOWN).all():
        return np.full(np.count_nonzero(unknown), 0.5, np.float32)
    dim = down(light)
    belief = prior and Belief(down(prior.alpha), 4 * prior.weight)
    slope, offset = _affine(dim, _solve(dim, small, belief, epsilon, direct), epsilon)
    size = (2 * half[0], 2 * half[1])
    up = [
        cv2.resize(x, size, interpolation=cv2.INTER_LINEAR)[:h, :w][unknown]
        for x in (slope, offset)
    ]
    return np.clip(up[0] * light[unknown] + up[1], 0.0, 1.0)


def _affine(light: _Light, matte: _Light, epsilon: float) -> tuple[_Light, _Light]:
    """Fit alpha = slope * light + offset in each window, and average the fits."""

    def mean(x: np.ndarray) -> np.ndarray:
        return cv2.blur(x, (3, 3), borderType=cv2.BORDER_REFLECT)

    x, y = light.astype(np.float64), matte.astype(np.float64)
    mean_x, mean_y = mean(x), mean(y)
    slope = (mean(x * y) - mean_x * mean_y) / (
        np.maximum(mean(x * x) - mean_x * mean_x, 0.0) + epsilon / 9
    )
    offset = mean_y - slope * mean_x
    return mean(slope).astype(np.float32), mean(offset).astype(np.float32)
