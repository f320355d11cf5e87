"""A facade knows itself: what a hole hides is looked up where the front repeats.

Windows stand on axes and floors, so a front straightened resembles itself, shifted by a
few *dominant offsets*. They are the peaks of the masked autocorrelation of what is
known (Padfield, "Masked Object Registration in the Fourier Domain"). A texel p of the
hole is then copied from p + o, for those offsets o under which the surroundings of p
agree best, and the copy is shaded to meet the known texels on the hole's border.

Letters: o an offset (x, y) in texels, p a texel.
"""

import cv2
import numpy as np
from jaxtyping import Float, Int
from scipy import fft, ndimage

from nostalgin_core.arrays import Mask
from nostalgin_core.smooth import Values, fill

Offsets = Int[np.ndarray, "n 2"]  # x, y
Spread = Float[np.ndarray, "rows columns"]  # one entry an offset

LEAST_OVERLAP = 0.08  # of all known texels: an agreement of fewer is chance
LEAST_AGREEMENT = 0.12  # correlation of a peak that is worth trying
ENOUGH_SHARE = 0.1  # of a neighbourhood known at both ends, to judge by it fully
NOISE = 2.0  # gray levels: what varies less agrees by chance
FAVOUR = 12.0  # a correlation higher by 0.1 weighs about three times as much


def detail(values: Values, known: Mask, *, radius: int) -> Values:
    """Take off the local mean of what is known; zero where nothing is."""
    size = (2 * radius + 1,) * 2
    weight = cv2.blur(known.astype(np.float32), size)
    mean = cv2.blur(np.where(known, values, 0).astype(np.float32), size)
    mean = mean / np.maximum(weight, 1e-6)
    return np.where(known, values - mean, 0).astype(np.float32)


def autocorrelation(values: Values, known: Mask) -> Spread:
    """Correlate what is known with itself at every offset; the centre is offset zero.

    r(o) = sum v(p) v(p + o) / sqrt(sum v(p)^2 sum v(p + o)^2), each sum over the texels
    known at both p and p + o; zero where they are too few.
    """
    h, w = values.shape
    shape = [fft.next_fast_len(2 * n, real=True) for n in (h, w)]
    v, v2, m = (
        fft.rfft2(a.astype(np.float32), shape) for a in (values, values**2, known)
    )

    def spread(product: np.ndarray) -> Spread:
        whole = fft.irfft2(product, shape)
        return np.roll(whole, (h - 1, w - 1), (0, 1))[: 2 * h - 1, : 2 * w - 1]

    overlap = spread(m.conj() * m)
    energy = spread(m.conj() * v2) * spread(v2.conj() * m)
    r = spread(v.conj() * v) / np.sqrt(np.maximum(energy, 1e-6 * energy.max() + 1e-9))
    return np.where(overlap > LEAST_OVERLAP * known.sum(), r, 0).astype(np.float32)


def offsets(values: Values, known: Mask, *, count: int = 24) -> Offsets:
    """Find the shifts under which what is known agrees best with itself."""
    h, w = values.shape
    radius = max(4, min(h, w) // 10)
    r = autocorrelation(detail(values, known, radius=radius), known)
    near = max(2, min(h, w) // 40)
    peaks = (r == ndimage.maximum_filter(r, 2 * near + 1)) & (r > LEAST_AGREEMENT)
    peaks[h - 1 - 2 * near : h + 2 * near, w - 1 - 2 * near : w + 2 * near] = False
    y, x = np.nonzero(peaks)
    best = np.argsort(-r[y, x], kind="stable")[:count]
    return np.column_stack([x[best] - (w - 1), y[best] - (h - 1)])


def shifted(a: np.ndarray, o: np.ndarray) -> np.ndarray:
    """Look up `a` at p + o for every p; zero where that leaves it."""
    x, y = int(o[0]), int(o[1])
    h, w = a.shape
    out = np.zeros_like(a)
    rows = slice(max(0, -y), min(h, h - y))
    columns = slice(max(0, -x), min(w, w - x))
    if rows.start < rows.stop and columns.start < columns.stop:
        out[rows, columns] = a[
            rows.start + y : rows.stop + y, columns.start + x : columns.stop + x
        ]
    return out


def copy(
    values: Values, known: Mask, choices: Offsets, *, radius: int
) -> tuple[Values, Values]:
    """Copy into every texel from where the front repeats.

    Each offset is judged round every texel by the correlation of the detail there
    with the detail where it leads; the copies are averaged with weights that favour
    the best.

    Returns the copy and its trust, 0 to 1: the correlation reached; 0 where no copy is.
    """
    size = (2 * radius + 1,) * 2
    plain = detail(values, known, radius=radius)
    total, weights, trust = np.zeros((3, *values.shape), np.float32)
    for o in choices:
        there = shifted(known, o)
        both = (there & known).astype(np.float32)
        copied = shifted(values, o)
        mine, theirs = plain * both, shifted(plain, o) * both
        share, dot, own, other, shade = (
            cv2.blur(a, size, borderType=cv2.BORDER_CONSTANT)
            for a in (
                both,
                mine * theirs,
                mine * mine,
                theirs * theirs,
                (values - copied) * both,
            )
        )
        norm = np.sqrt(np.maximum(own * other, 0)) + NOISE**2 * share
        r = np.where(there, dot / np.maximum(norm, 1e-6), 0).clip(0, 1)
        r *= np.minimum(share / ENOUGH_SHARE, 1)
        weight = np.expm1(FAVOUR * r)
        total += weight * (copied + shade / np.maximum(share, 1e-6))
        weights += weight
        trust = np.maximum(trust, r)
    return total / np.maximum(weights, 1e-6), trust


def guess(values: Values, hole: Mask) -> Values:
    """Fill a hole with what repeats, and with a membrane where nothing does.

    What the copies miss of the known texels, mostly shade, is carried into the hole by
    a membrane of its own.
    """
    known = ~hole
    smooth = fill(values, hole)
    choices = offsets(np.where(hole, 0, values), known)
    if len(choices) == 0:
        return smooth
    radius = max(6, min(values.shape) // 8)
    copied, trust = copy(np.where(hole, 0, values), known, choices, radius=radius)
    usable = trust > 0
    missed = fill(values - copied, hole | ~usable)
    made = smooth + trust * (copied + missed - smooth)
    return np.where(hole, np.where(usable, made, smooth), values).astype(np.float32)
