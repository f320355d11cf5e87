"""Closed-form matting solves for alpha on the unknown band alone, coarse to fine.

The alpha of least cost under the matting Laplacian, with the trimap's known pixels held
fixed (Levin, Lischinski and Weiss, PAMI 2008, equation 13, with lambda infinite). A
large band is solved at half the size first, as in Levin's published program.
"""

from collections.abc import Iterator
from typing import Final

import cv2
import numpy as np
from jaxtyping import Float, Float32

from nostalgin_core import banded, laplacian
from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.banded import Order
from nostalgin_core.laplacian import EPSILON, PAD, Belief
from nostalgin_core.trimap import BACKGROUND, FOREGROUND, UNKNOWN, Trimap

ENTRIES: Final = 8_000_000  # of one factor: 64 MB
_OVERLAP_PX: Final = 8  # of parts that are solved one after the other
_CRISP: Final = 0.02  # nearer than this to 0 or 1, the coarse alpha is believed

_Light = Float32[np.ndarray, "h w"]


def alpha(
    image: Gray,
    trimap: Trimap,
    *,
    prior: Belief | None = None,
    epsilon: float = EPSILON,
    entries: int = ENTRIES,
) -> _Light:
    """Find the alpha of least cost that agrees with the trimap where it is known.

    A band whose factor has more than `entries` numbers is solved at half the size
    first. There, alpha is brought to full size by its own local affine model, and
    solved again, part by part, where it is neither 0 nor 1: bounded memory, and for
    crisp outlines little work.

    Args:
        image: What the camera saw.
        trimap: Codes of `trimap`.
        prior: What to believe where the image does not tell.
        epsilon: n times the variance below which a window counts as even; white is 1.
        entries: The size of the largest factor.

    Raises:
        ValueError: if the trimap knows no pixel at all.
    """
    if not ((trimap == BACKGROUND) | (trimap == FOREGROUND)).any():
        message = f"a trimap of {trimap.shape} without a known pixel"
        raise ValueError(message)
    light = image.astype(np.float32) / np.float32(255.0)
    result = _solve(light, trimap, prior, epsilon, entries)
    return np.clip(result, 0.0, 1.0)


def _solve(
    light: _Light, trimap: Trimap, prior: Belief | None, epsilon: float, entries: int
) -> _Light:
    unknown = (trimap != BACKGROUND) & (trimap != FOREGROUND)
    result = (trimap == FOREGROUND).astype(np.float32)
    numbering = banded.order(unknown)
    if numbering.entries > entries:
        guess = _from_half(light, trimap, prior, epsilon, entries)
        unsettled = ((guess > _CRISP) & (guess < 1 - _CRISP)).astype(np.uint8)
        result[unknown] = np.round(guess[unknown])
        unknown &= cv2.dilate(unsettled, np.ones((5, 5), np.uint8)) > 0
        result[unknown] = guess[unknown]
        numbering = banded.order(unknown)
    for part, ranked in _parts(unknown, numbering, entries):
        result[part] = _exactly(
            light, part, ranked, result, prior=prior, epsilon=epsilon
        )
    return result


def _parts(
    unknown: Mask, numbering: Order, entries: int
) -> Iterator[tuple[Mask, Order]]:
    """Split a band until each part's factor is small enough, with some overlap.

    The parts are solved one after the other, each with the others' alpha as it is: what
    the coarse solution missed is local.
    """
    places = np.nonzero(unknown)
    extents = [int(np.ptp(axis)) if len(axis) else 0 for axis in places]
    if numbering.entries <= entries or max(extents) < 8 * _OVERLAP_PX:
        yield unknown, numbering
        return
    axis = int(np.argmax(extents))
    middle = int(np.median(places[axis]))
    for side in (slice(middle + _OVERLAP_PX), slice(middle - _OVERLAP_PX, None)):
        half = np.zeros_like(unknown)
        cut = (side, slice(None)) if axis == 0 else (slice(None), side)
        half[cut] = unknown[cut]
        yield from _parts(half, banded.order(half), entries)


def _exactly(
    light: _Light,
    unknown: Mask,
    numbering: Order,
    known: _Light,
    *,
    prior: Belief | None,
    epsilon: float,
) -> Float[np.ndarray, " n"]:
    """Solve for the unknown pixels at once, in their bounding box.

    Cutting it out changes neither the order of reading nor, so, the numbering.
    """
    if not unknown.any():
        return np.empty(0)
    y, x = (np.flatnonzero(unknown.any(axis=axis)) for axis in (1, 0))
    part = tuple(slice(max(0, a[0] - PAD), a[-1] + PAD + 1) for a in (y, x))
    here = prior and Belief(prior.alpha[part], prior.weight)
    equations = laplacian.system(
        light[part], unknown[part], known[part], prior=here, epsilon=epsilon
    )
    return banded.solve(equations, numbering)


def _from_half(
    light: _Light, trimap: Trimap, prior: Belief | None, epsilon: float, entries: int
) -> _Light:
    """Solve at half the size, and bring alpha up by its affine model of the image.

    This is the coarse-to-fine scheme of Levin's published program.
    """
    h, w = light.shape
    half = ((w + 1) // 2, (h + 1) // 2)

    def down(array: np.ndarray) -> np.ndarray:
        even = cv2.copyMakeBorder(array, 0, h % 2, 0, w % 2, cv2.BORDER_REPLICATE)
        return cv2.resize(even, half, interpolation=cv2.INTER_AREA)

    small = np.full(half[::-1], UNKNOWN, np.uint8)
    small[down((trimap == FOREGROUND).astype(np.float32)) >= 1.0] = FOREGROUND
    small[down((trimap == BACKGROUND).astype(np.float32)) >= 1.0] = BACKGROUND
    if (small == UNKNOWN).all():
        return np.full(light.shape, 0.5, np.float32)
    dim = down(light)
    belief = prior and Belief(down(prior.alpha.astype(np.float32)), prior.weight)
    slope, offset = _affine(dim, _solve(dim, small, belief, epsilon, entries), epsilon)
    size = (2 * half[0], 2 * half[1])
    up = [cv2.resize(x, size, interpolation=cv2.INTER_LINEAR) for x in (slope, offset)]
    return np.clip(up[0][:h, :w] * light + up[1][:h, :w], 0.0, 1.0)


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
