"""The matting Laplacian couples pixels whose alpha is affine in the same gray levels.

In a small window k, alpha is nearly an affine function of the gray level I, and the
cost of departing from that is a quadratic form whose matrix is the *matting Laplacian*
(Levin, Lischinski and Weiss, "A Closed-Form Solution to Natural Image Matting", PAMI
2008, equation 12). For one channel, windows of n = 9 pixels with mean mu_k and variance
sigma_k^2, it is

    L_ij = sum over k containing i and j of
           delta_ij - (1/n) (1 + (I_i - mu_k) (I_j - mu_k) / v_k),
    v_k = sigma_k^2 + epsilon/n.

The sum over k splits into three that know nothing of i and j but which windows hold
both, so that each diagonal of the matrix costs a few vector operations:

    L_ij = delta_ij count_i - (A_ij - (I_i + I_j) B_ij + I_i I_j S_ij)
    A = sum (1 + mu^2/v)/n,   B = sum mu/(n v),   S = sum 1/(n v)

Known pixels are constants, so only rows of unknown pixels are assembled, from windows
that touch them.
"""

from typing import Final, NamedTuple

import cv2
import numpy as np
from jaxtyping import Float, Int, Int32

from nostalgin_core.arrays import Alpha, Mask

EPSILON: Final = 1e-7  # Levin's own: squared gray levels, where white is 1
PAD: Final = 2  # how far a window that holds a pixel reaches from it
_N: Final = 9


class Belief(NamedTuple):
    """What alpha probably is, and how strongly: against a diagonal of order 1."""

    alpha: Alpha
    weight: float


class System(NamedTuple):
    """The equations L_uu alpha_u = -L_uk alpha_k, upper half, by diagonals.

    `values[d, p]` couples unknown p with unknown `neighbours[d, p]`, which comes later
    in the order of reading (or is p itself, for d = 0); -1 where that pixel is known.
    """

    values: Float[np.ndarray, "d n"]
    neighbours: Int32[np.ndarray, "d n"]
    right: Float[np.ndarray, " n"]


def system(
    light: Float[np.ndarray, "h w"],
    unknown: Mask,
    known: Alpha,
    *,
    prior: Belief | None = None,
    epsilon: float = EPSILON,
) -> System:
    """Assemble the equations of the unknown pixels, in the order of reading."""
    h, w = light.shape
    padded = np.pad(light.astype(np.float64), PAD)
    levels = padded.ravel()
    pixels, number = numbered(unknown)
    known_alpha = np.pad(np.where(unknown, 0.0, known), PAD).ravel()
    held, right = _windows(padded, unknown, known_alpha, pixels, epsilon)
    here = levels[pixels]
    values = np.empty((len(LATER), len(pixels)))
    neighbours = np.empty((len(LATER), len(pixels)), np.int32)
    for d, (dy, dx) in enumerate(LATER):
        there = pixels + (dy * padded.shape[1] + dx)
        a, b, s = _overlap(held, dy, dx)
        light_there = levels[there]
        values[d] = (here + light_there) * b - a - here * light_there * s
        neighbours[d] = number[there]
    y, x = np.nonzero(unknown)
    values[0] += _count(y, h) * _count(x, w)
    if prior is not None:
        values[0] += prior.weight
        right += prior.weight * prior.alpha[unknown]
    return System(values, neighbours, right)


# Where a pixel's later neighbours lie; the earlier ones follow from symmetry.
LATER: Final = [(dy, dx) for dy in range(3) for dx in range(-2, 3) if dy > 0 or dx >= 0]


def numbered(
    unknown: Mask,
) -> tuple[Int[np.ndarray, " n"], Int32[np.ndarray, " padded"]]:
    """Give the unknowns' places in the padded image, and every place's number or -1."""
    padded = np.pad(unknown, PAD).ravel()
    pixels = np.flatnonzero(padded)
    number = np.full(padded.size, -1, np.int32)
    number[pixels] = np.arange(len(pixels), dtype=np.int32)
    return pixels, number


def _count(places: Int[np.ndarray, " n"], size: int) -> Int[np.ndarray, " n"]:
    """Count, along one axis, the whole windows that hold each place."""
    return np.minimum(places + 1, size - 2) - np.maximum(places - 1, 1) + 1


def _windows(
    padded: Float[np.ndarray, "padded_h padded_w"],
    unknown: Mask,
    known_alpha: Float[np.ndarray, " padded"],
    pixels: Int[np.ndarray, " n"],
    epsilon: float,
) -> tuple[Float[np.ndarray, "3 3 3 n"], Float[np.ndarray, " n"]]:
    """Give each unknown A, B and S of its nine windows, and its right side.

    With beta the slope that alpha's known part has against I in a window, the right
    side is the sum over windows of mean(alpha) + beta (I_i - mu). A window that reaches
    out of the image counts nothing.
    """
    width = padded.shape[1]
    touched = cv2.dilate(unknown.astype(np.uint8), np.ones((3, 3), np.uint8))
    touched[[0, -1]] = 0
    touched[:, [0, -1]] = 0
    centres = np.flatnonzero(np.pad(touched, PAD))
    around = [dy * width + dx for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
    lights = np.stack([padded.ravel()[centres + step] for step in around])
    alphas = np.stack([known_alpha[centres + step] for step in around])
    mean = lights.mean(axis=0)
    lights -= mean
    s = 1.0 / ((lights * lights).sum(axis=0) + epsilon)
    beta = (lights * alphas).sum(axis=0) * s
    # The last column is the window that counts nothing.
    fields = np.zeros((5, len(centres) + 1))
    fields[:, :-1] = (
        1.0 / _N + mean * mean * s,
        mean * s,
        s,
        alphas.mean(axis=0) - beta * mean,
        beta,
    )
    number = np.full(padded.size, len(centres), np.int32)
    number[centres] = np.arange(len(centres), dtype=np.int32)
    held = np.empty((5, 9, len(pixels)))
    for place, step in enumerate(around):
        np.take(fields, number[pixels + step], axis=1, out=held[:, place], mode="clip")
    right = held[3].sum(axis=0) + padded.ravel()[pixels] * held[4].sum(axis=0)
    return held[:3].reshape(3, 3, 3, -1), right


def _overlap(
    held: Float[np.ndarray, "3 3 3 n"], dy: int, dx: int
) -> Float[np.ndarray, "3 n"]:
    """Add up the windows that hold both a pixel and its neighbour at (dy, dx)."""
    ys = range(max(0, dy), min(3, 3 + dy))
    xs = range(max(0, dx), min(3, 3 + dx))
    total = np.zeros_like(held[:, 0, 0])
    for y in ys:
        for x in xs:
            total += held[:, y, x]
    return total
