"""A facade knows itself: what a hole hides is looked up where the front repeats.

Windows stand on axes and floors, so a front straightened resembles itself, shifted by a
few *dominant offsets*. They are the peaks of the masked autocorrelation of what is
known (Padfield, "Masked Object Registration in the Fourier Domain"). A texel p of the
hole is then copied from p + o, for those offsets o under which the surroundings of p
agree best, and the copy is shaded to meet the known texels on the hole's border.

Letters: o an offset (x, y) in texels, p a texel.
"""

from collections.abc import Iterator

import cv2
import numpy as np
from jaxtyping import Bool, Float, Shaped
from scipy import ndimage

from nostalgin_core.arrays import Mask
from nostalgin_core.records import Box
from nostalgin_core.slices import grown
from nostalgin_core.smooth import Half, Values, fill

Offsets = Shaped[np.ndarray, "n 2"]  # x, y
HalfMask = Bool[np.ndarray, "h2 w2"]
Rates = Float[np.ndarray, " n"]  # correlations
Spread = Float[np.ndarray, "rows columns"]  # one entry an offset

COUNT = 32  # offsets tried
JUDGED_PX = 160_000  # larger fronts are judged at this size
LEAST_OVERLAP = 0.08  # of all known texels: an agreement of fewer is chance
LEAST_AGREEMENT = 0.12  # correlation of a peak that is worth trying
DOUBT = 0.02  # share of a neighbourhood that must be known to outweigh the whole front
SHADED = 0.5  # how far the membrane is believed about shade, where nothing else tells
FAVOUR = 18.0  # a correlation higher by 0.1 weighs six times as much
RIM_PX = 4  # width of the fade at the rim of what can be copied
BAND_PX = 64  # of what is known round the hole, to compare copies with
BOLD = 0.75  # 1 measures best, but looks pale; less keeps the copy's contrast
NOISE = 2.0  # gray levels: what varies less agrees by chance


def reach(values: Values) -> int:
    """Say how far round a texel is looked: about a window's height."""
    return max(6, min(values.shape) // 8)


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
    known at both p and p + o, with the noise added below the line; zero where they
    are too few.
    """
    h, w = values.shape
    shape = [cv2.getOptimalDFTSize(2 * n) for n in (h, w)]
    v, v2, m = (
        np.fft.rfft2(a.astype(np.float32), shape) for a in (values, values**2, known)
    )

    def spread(product: np.ndarray) -> Spread:
        whole = np.fft.irfft2(product, shape)
        return np.roll(whole, (h - 1, w - 1), (0, 1))[: 2 * h - 1, : 2 * w - 1]

    overlap = spread(m.conj() * m)
    energy = spread(m.conj() * v2) * spread(v2.conj() * m)
    norm = np.sqrt(np.maximum(energy, 0)) + NOISE**2 * np.maximum(overlap, 1)
    r = spread(v.conj() * v) / norm
    return np.where(overlap > LEAST_OVERLAP * known.sum(), r, 0).astype(np.float32)


def offsets(
    values: Values, known: Mask, *, count: int = COUNT
) -> tuple[Offsets, Rates]:
    """Find the shifts under which what is known agrees best with itself.

    Each peak is placed between texels by the parabola through its neighbours.

    Returns the offsets, the best first, and the correlation that each reaches.
    """
    h, w = values.shape
    r = autocorrelation(detail(values, known, radius=reach(values)), known)
    near = max(2, min(h, w) // 40)
    peaks = (r == ndimage.maximum_filter(r, 2 * near + 1)) & (r > LEAST_AGREEMENT)
    peaks[h - 1 - 2 * near : h + 2 * near, w - 1 - 2 * near : w + 2 * near] = False
    peaks[[0, -1]] = peaks[:, [0, -1]] = False
    y, x = np.nonzero(peaks)
    best = np.argsort(-r[y, x], kind="stable")[:count]
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


def shifted(a: np.ndarray, o: np.ndarray, within: Box | None = None) -> np.ndarray:
    """Look up `a` at p + o for every p of a box; zero where that leaves it."""
    h, w = a.shape
    x0, y0, x1, y1 = within or (0, 0, w, h)
    x, y = int(o[0]), int(o[1])
    out = np.zeros((y1 - y0, x1 - x0), a.dtype)
    top, bottom = max(0, y0 + y), min(h, y1 + y)
    left, right = max(0, x0 + x), min(w, x1 + x)
    if top < bottom and left < right:
        rows = slice(top - y0 - y, bottom - y0 - y)
        columns = slice(left - x0 - x, right - x0 - x)
        out[rows, columns] = a[top:bottom, left:right]
    return out


def agreements(
    values: Values, known: Mask, choices: Offsets, rates: Rates
) -> Iterator[tuple[Values, Values]]:
    """Judge each offset round every texel: how well it agrees, and what shade it lacks.

    Agreement is the correlation of the detail here with the detail where the offset
    leads. Where too little is known at both ends, as deep inside a hole, the offset's
    correlation over the whole front stands in, and the membrane tells the shade.
    """
    size = (2 * reach(values) + 1,) * 2
    plain = detail(values, known, radius=reach(values))
    base = cv2.blur(fill(values, ~known), size)
    for o, rate in zip(choices, rates, strict=True):
        there = shifted(known, o)
        both = (there & known).astype(np.float32)
        mine, theirs = plain * both, shifted(plain, o) * both
        share, dot, own, other, shade = (
            cv2.blur(a, size, borderType=cv2.BORDER_CONSTANT)
            for a in (
                both,
                mine * theirs,
                mine * mine,
                theirs * theirs,
                (values - shifted(values, o)) * both,
            )
        )
        norm = np.sqrt(np.maximum(own * other, 0)) + NOISE**2 * share
        r = dot / np.maximum(norm, 1e-6)
        r = (r * share + DOUBT * rate) / (share + DOUBT)
        shade = (shade + DOUBT * SHADED * (base - shifted(base, o))) / (share + DOUBT)
        yield np.where(there, r, 0).clip(0, 1), shade


def _inward(there: Mask) -> Values:
    """Rise from 0 at the rim of what can be copied to 1 inside, to hide the rim."""
    size = (2 * RIM_PX + 1,) * 2
    near = cv2.blur(there.astype(np.float32), size, borderType=cv2.BORDER_REPLICATE)
    return np.where(there, 2 * near - 1, 0).clip(0, 1)


def _smaller(values: Values, known: Mask) -> tuple[Half, HalfMask]:
    """Shrink a large front to the size at which it is judged."""
    h, w = values.shape
    shrink = (JUDGED_PX / (h * w)) ** 0.5
    if shrink >= 1:
        return values, known
    size = (max(1, round(w * shrink)), max(1, round(h * shrink)))
    part = cv2.resize(known.astype(np.float32), size, interpolation=cv2.INTER_AREA)
    mean = cv2.resize(values * known, size, interpolation=cv2.INTER_AREA)
    return mean / np.maximum(part, 1e-6), part > 0.5


def copy(values: Values, known: Mask, within: Box) -> tuple[Half, Half]:
    """Copy into every texel of a box from where the front repeats.

    The copies are averaged with weights that favour the offsets that agree best.
    Offsets are found and judged at a small size and used at the full one.

    Returns the copy and its trust, 0 to 1: the agreement reached; 0 where no copy is.
    """
    h, w = values.shape
    small, seen = _smaller(values, known)
    choices, rates = offsets(small, seen)
    scale = np.array([w / small.shape[1], h / small.shape[0]])
    full = np.round(choices * scale).astype(int)
    # Where the box's texel centres lie in the small front.
    columns = (np.arange(within.x0, within.x1, dtype=np.float32) + 0.5) / scale[0] - 0.5
    rows = (np.arange(within.y0, within.y1, dtype=np.float32) + 0.5) / scale[1] - 0.5
    at = [a.astype(np.float32) for a in np.meshgrid(columns, rows)]
    total, weights, trust = np.zeros((3, len(rows), len(columns)), np.float32)
    judged = agreements(small, seen, np.round(choices).astype(int), rates)
    for o, (r, shade) in zip(full, judged, strict=True):
        weight, agreed, lacking = (
            cv2.remap(
                np.asarray(a, np.float32),
                at[0],
                at[1],
                cv2.INTER_LINEAR,
                borderMode=cv2.BORDER_REPLICATE,
            )
            for a in (np.expm1(FAVOUR * r) * _inward(r > 0), r, shade)
        )
        weight *= shifted(known, o, within)
        total += weight * (shifted(values, o, within) + lacking)
        weights += weight
        np.maximum(trust, agreed, out=trust, where=weight > 0)
    return total / np.maximum(weights, 1e-6), trust


def guess(values: Values, hole: Mask) -> Values:
    """Fill a hole with what repeats, and with a membrane where nothing does.

    What the copies miss of the known texels, mostly shade, is carried into the hole by
    a membrane of its own.
    """
    made = fill(values, hole)
    if not hole.any():
        return made
    rows, columns = (np.flatnonzero(hole.any(axis=a)) for a in (1, 0))
    tight = Box(*(int(n) for n in (columns[0], rows[0], columns[-1] + 1, rows[-1] + 1)))
    box = grown(tight, BAND_PX, hole.shape)
    copied, trust = copy(np.where(hole, 0, values).astype(np.float32), ~hole, box)
    window = np.s_[box.y0 : box.y1, box.x0 : box.x1]
    usable = trust > 0
    missed = fill(values[window] - copied, hole[window] | ~usable)
    better = made[window] + trust**BOLD * (copied + missed - made[window])
    np.copyto(made[window], better, where=hole[window] & usable)
    return made
