"""The matting Laplacian is applied window by window, without ever being written down.

With d_ki = I_i - mu_k in window k, s_k = 1 / (sum_i d_ki^2 + epsilon) and n = 9, each
window takes off alpha what an affine function of the gray level explains of it, so

    L = C - M' M,   M = [1/3 on the pixels of each window; sqrt(s_k) d_ki on them]

where C counts the windows that hold a pixel (Levin, Lischinski and Weiss 2008, equation
12, rearranged). M has 18 entries a window and takes a few vector operations to make.
Only differences of gray levels inside a window occur in it, so that float32 holds it,
though not the entries of L. For a direct solution `laplacian` writes L down.
"""

from typing import NamedTuple

import cv2
import numpy as np
from jaxtyping import Float32, Int
from scipy import sparse

from nostalgin_core.arrays import Mask

_N = 9


class Windows(NamedTuple):
    """All windows that hold an unknown pixel, and the pixels that they hold.

    `places[p]` is where pixel p lies in the image; `unknown` is 1 there or 0.
    """

    matrix: sparse.csr_array  # M
    transposed: sparse.csc_array  # M', the same numbers
    places: Int[np.ndarray, " p"]
    unknown: Float32[np.ndarray, " p"]
    counts: Float32[np.ndarray, " p"]  # C
    diagonal: Float32[np.ndarray, " p"]  # of L

    def residual(self, alpha: Float32[np.ndarray, " p"]) -> Float32[np.ndarray, " p"]:
        """Return L alpha where alpha is unknown, 0 elsewhere."""
        explained = self.transposed @ (self.matrix @ alpha)
        return (self.counts * alpha - explained) * self.unknown


def windows(
    light: Float32[np.ndarray, "h w"], unknown: Mask, *, epsilon: float
) -> Windows:
    """Collect the windows that touch the unknown; one that leaves the image is none."""
    width = light.shape[1]
    square = np.ones((3, 3), np.uint8)
    touched = cv2.dilate(unknown.astype(np.uint8), square)
    touched[[0, -1]] = 0
    touched[:, [0, -1]] = 0
    held = (cv2.dilate(touched, square) > 0) | unknown
    places = np.flatnonzero(held)
    number = np.empty(held.size, np.int32)
    number[places] = np.arange(len(places), dtype=np.int32)
    centres = np.flatnonzero(touched)
    steps = [dy * width + dx for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
    around = centres[:, None] + np.array(steps)
    pixels = number[around].ravel()
    data = np.empty((2, len(centres), _N), np.float32)
    data[0] = 1 / 3
    data[1] = light.ravel()[around]
    data[1] -= data[1].mean(axis=1, keepdims=True)
    data[1] /= np.sqrt((data[1] ** 2).sum(axis=1, keepdims=True) + np.float32(epsilon))
    matrix = sparse.csr_array(
        (
            data.ravel(),
            np.concatenate([pixels, pixels]),
            np.arange(0, data.size + 1, _N, dtype=np.int32),
        ),
        shape=(2 * len(centres), len(places)),
    )
    counts = np.bincount(pixels, minlength=len(places)).astype(np.float32)
    taken = np.bincount(pixels, (data**2).sum(axis=0).ravel(), len(places))
    return Windows(
        matrix,
        matrix.T,
        places,
        unknown.ravel()[places].astype(np.float32),
        counts,
        (counts - taken).astype(np.float32),
    )
