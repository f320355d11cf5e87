"""Where a front resembles itself: shifted by axes and floors, or seen in a mirror.

Windows stand on axes and floors, so a front straightened resembles itself, shifted by a
few *dominant offsets*: the peaks of the masked autocorrelation of what is known
(Padfield, "Masked Object Registration in the Fourier Domain"). Builders loved symmetry,
too, so that a front, a bay or a window resembles its mirror image, shifted likewise: a
half of the best offsets are such.

Letters: o an offset (x, y) in texels, p a texel; v the front, u its source: the front
itself or its mirror image.
"""

from typing import NamedTuple

import cv2
import numpy as np
from jaxtyping import Bool, Complex, Float, Shaped
from scipy import ndimage

from nostalgin_core.arrays import Mask
from nostalgin_core.inpaint.smooth import Values

Offsets = Shaped[np.ndarray, "n 2"]  # x, y
Flags = Bool[np.ndarray, " n"]
Rates = Float[np.ndarray, " n"]  # correlations
Spectra = Complex[np.ndarray, "3 h3 w3"]  # of values, their squares, known
Spread = Float[np.ndarray, "rows columns"]  # one entry an offset

COUNT = 16  # offsets tried: more only add chance resemblances
LEAST_OVERLAP = 0.08  # of all known texels: an agreement of fewer is chance
LEAST_AGREEMENT = 0.12  # correlation of a peak that is worth trying
NOISE = 2.0  # gray levels: what varies less agrees by chance


class Resemblance(NamedTuple):
    """Where the front is found again, the best first."""

    offsets: Offsets
    mirrored: Flags  # the offset leads into the mirror image
    rates: Rates  # correlation over the whole front


def reach(values: Values) -> int:
    """Say how far round a texel is looked: about a window's height."""
    return max(6, min(values.shape) // 8)


def flipped(a: np.ndarray) -> np.ndarray:
    """Mirror left and right."""
    return np.ascontiguousarray(a[:, ::-1])


def detail(values: Values, known: Mask, *, radius: int) -> Values:
    """Take off the local mean of what is known; zero where nothing is."""
    size = (2 * radius + 1,) * 2
    weight = cv2.blur(known.astype(np.float32), size)
    mean = cv2.blur(np.where(known, values, 0).astype(np.float32), size)
    mean = mean / np.maximum(weight, 1e-6)
    return np.where(known, values - mean, 0).astype(np.float32)


def spectra(values: Values, known: Mask) -> Spectra:
    """Transform what is known, its square and where it is, with room to shift."""
    shape = [cv2.getOptimalDFTSize(2 * n) for n in values.shape]
    return np.stack(
        [np.fft.rfft2(a.astype(np.float32), shape) for a in (values, values**2, known)]
    )


def correlation(here: Spectra, source: Spectra, shape: tuple[int, int]) -> Spread:
    """Correlate a front with its source at every offset; the centre is offset 0.

    r(o) = sum v(p) u(p + o) / sqrt(sum v(p)^2 sum u(p + o)^2), each sum over the texels
    known at both p and p + o, with the noise added below the line; zero where they
    are too few.
    """
    h, w = shape
    padded = [cv2.getOptimalDFTSize(2 * n) for n in shape]
    (v, _, m), (u, u2, n) = here.conj(), source

    def spread(product: np.ndarray) -> Spread:
        every = np.fft.irfft2(product, padded)
        return np.roll(every, (h - 1, w - 1), (0, 1))[: 2 * h - 1, : 2 * w - 1]

    overlap = spread(m * n)
    theirs = spread(m * u2)
    # Seen from the source, an offset points the other way: both ways in the front
    # itself, but across alike in a mirror.
    mine = theirs[::-1, ::-1] if here is source else theirs[::-1]
    norm = np.sqrt(np.maximum(theirs * mine, 0)) + NOISE**2 * np.maximum(overlap, 1)
    enough = overlap > LEAST_OVERLAP * m[0, 0].real  # which is the sum of all known
    return np.where(enough, spread(v * u) / norm, 0).astype(np.float32)


def peaks(
    r: Spread, shape: tuple[int, int], *, mirrored: bool
) -> tuple[Offsets, Rates]:
    """Find the offsets that agree better than all near them, the best first.

    Each peak is placed between texels by the parabola through its neighbours. That the
    front resembles itself unshifted says nothing, but a mirror image may well lie so.
    """
    h, w = shape
    near = max(2, min(h, w) // 40)
    top = (r == ndimage.maximum_filter(r, 2 * near + 1)) & (r > LEAST_AGREEMENT)
    if not mirrored:
        top[h - 1 - 2 * near : h + 2 * near, w - 1 - 2 * near : w + 2 * near] = False
    top[[0, -1]] = top[:, [0, -1]] = False
    y, x = np.nonzero(top)
    best = np.argsort(-r[y, x], kind="stable")
    y, x = y[best], x[best]
    fine = [
        at + _vertex(r[y - dy, x - dx], r[y, x], r[y + dy, x + dx])
        for at, dy, dx in ((x, 0, 1), (y, 1, 0))
    ]
    return np.column_stack(fine) - [w - 1, h - 1], r[y, x]


def _vertex(before: Rates, at: Rates, after: Rates) -> Rates:
    """Find the top of the parabola through three neighbours, from the middle one."""
    bend = 2 * at - before - after
    return ((after - before) / (2 * np.maximum(bend, 1e-6))).clip(-0.5, 0.5)


def resemblance(values: Values, known: Mask, *, count: int = COUNT) -> Resemblance:
    """Find the best shifts into the front itself and into its mirror image."""
    plain = detail(values, known, radius=reach(values))
    here = spectra(plain, known)
    mirror = spectra(flipped(plain), flipped(known))
    found = [
        peaks(
            correlation(here, source, values.shape),
            values.shape,
            mirrored=source is mirror,
        )
        for source in (here, mirror)
    ]
    rates = np.concatenate([rate for _, rate in found])
    sides = np.repeat([False, True], [len(rate) for _, rate in found])
    best = np.argsort(-rates, kind="stable")[:count]
    every = np.concatenate([shift for shift, _ in found])
    return Resemblance(every[best], sides[best], rates[best])
