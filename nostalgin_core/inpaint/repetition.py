"""A facade knows itself: what a hole hides is looked up where the front repeats.

A texel p of the hole is copied from p + o, for those dominant offsets o (`resemblance`)
under which the surroundings of p agree best, in the front or in its mirror image, and
the copy is shaded to meet the known texels on the hole's border.

Letters: o an offset (x, y) in texels, p a texel.
"""

from collections.abc import Iterator
from typing import NamedTuple

import cv2
import numpy as np
from jaxtyping import Bool, Float32

from nostalgin_core.arrays import Mask
from nostalgin_core.inpaint.ground_floor import darkening
from nostalgin_core.inpaint.resemblance import (
    NOISE,
    Resemblance,
    detail,
    flipped,
    reach,
    resemblance,
)
from nostalgin_core.inpaint.slices import grown
from nostalgin_core.inpaint.smooth import Half, Values, fill, flow
from nostalgin_core.records import Box

HalfMask = Bool[np.ndarray, "h2 w2"]
Window = Float32[np.ndarray, "h3 w3"]

JUDGED_PX = 100_000  # larger fronts are judged at this size
DOUBT = 0.05  # share of a neighbourhood that must be known to outweigh the whole front
SHADED = 0.5  # how far the membrane is believed about shade, where nothing else tells
FAVOUR = 18.0  # a correlation higher by 0.1 weighs six times as much
RIM_PX = 4  # width of the fade at the rim of what can be copied
BAND_PX = 64  # of what is known round the hole, to compare copies with
BOLD = 0.75  # 1 measures best, but looks pale; less keeps the copy's contrast


class Side(NamedTuple):
    """A front or its mirror image, as copies are judged by."""

    values: Values
    known: Mask
    detail: Values
    base: Values  # the membrane's local mean

    def mirrored(self) -> "Side":
        """See all of it in a mirror."""
        return Side(*(flipped(a) for a in self))


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
    values: Values, known: Mask, found: Resemblance, within: Box
) -> Iterator[tuple[Window, Window]]:
    """Judge each offset round every texel of a box: agreement, and the shade it lacks.

    Agreement is the correlation of the detail here with the detail where the offset
    leads. Where too little is known at both ends, as deep inside a hole, the offset's
    correlation over the whole front stands in, and the membrane tells the shade.
    """
    radius = reach(values)
    size = (2 * radius + 1,) * 2
    wide = grown(within, radius, values.shape)
    window = np.s_[wide.y0 : wide.y1, wide.x0 : wide.x1]
    inner = np.s_[
        within.y0 - wide.y0 : within.y1 - wide.y0,
        within.x0 - wide.x0 : within.x1 - wide.x0,
    ]
    base = cv2.blur(fill(values, ~known), size)
    here = Side(values, known, detail(values, known, radius=radius), base)
    sides = (here, here.mirrored())
    mine = Side(*(a[window] for a in here))
    for o, mirrored, rate in zip(*found, strict=True):
        there = Side(*(shifted(a, o, wide) for a in sides[int(mirrored)]))
        both = (there.known & mine.known).astype(np.float32)
        own, other = mine.detail * both, there.detail * both
        share, dot, power, theirs, shade = (
            cv2.blur(a, size, borderType=cv2.BORDER_CONSTANT)
            for a in (
                both,
                own * other,
                own * own,
                other * other,
                (mine.values - there.values) * both,
            )
        )
        norm = np.sqrt(np.maximum(power * theirs, 0)) + NOISE**2 * share
        r = dot / np.maximum(norm, 1e-6)
        r = (r * share + DOUBT * rate) / (share + DOUBT)
        guessed = DOUBT * SHADED * (mine.base - there.base)
        shade = (shade + guessed) / (share + DOUBT)
        yield np.where(there.known, r, 0).clip(0, 1)[inner], shade[inner]


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


def _box_in(box: Box, scale: np.ndarray, shape: tuple[int, int]) -> Box:
    """Give the box of a shrunken front that a box's texels are looked up in."""
    low = np.floor((np.array(box[:2]) + 0.5) / scale - 0.5).astype(int)
    high = np.ceil((np.array(box[2:]) - 0.5) / scale - 0.5).astype(int) + 1
    (x0, y0), (x1, y1) = low.tolist(), high.tolist()
    return Box(max(0, x0), max(0, y0), min(shape[1], x1), min(shape[0], y1))


def copy(values: Values, known: Mask, within: Box) -> tuple[Half, Half]:
    """Copy into every texel of a box from where the front repeats.

    The copies are averaged with weights that favour the offsets that agree best.
    Offsets are found and judged at a small size and used at the full one.

    Returns the copy and its trust, 0 to 1: the agreement reached; 0 where no copy is.
    """
    h, w = values.shape
    small, seen = _smaller(values, known)
    found = resemblance(small, seen)
    scale = np.array([w / small.shape[1], h / small.shape[0]])
    full = np.round(found.offsets * scale).astype(int)
    near = _box_in(within, scale, small.shape)
    # Where the box's texel centres lie in the small front's box.
    columns = (np.arange(within.x0, within.x1) + 0.5) / scale[0] - 0.5 - near.x0
    rows = (np.arange(within.y0, within.y1) + 0.5) / scale[1] - 0.5 - near.y0
    x, y = (a.astype(np.float32) for a in np.meshgrid(columns, rows))
    total, weights, trust = np.zeros((3, len(rows), len(columns)), np.float32)
    whole = found._replace(offsets=np.round(found.offsets).astype(int))
    judged = agreements(small, seen, whole, near)
    sides = ((values, known), (flipped(values), flipped(known)))
    for o, mirrored, (r, shade) in zip(full, found.mirrored, judged, strict=True):
        weight, agreed, lacking = (
            cv2.remap(a, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
            for a in (np.expm1(FAVOUR * r) * _inward(r > 0), r, shade)
        )
        copied, offered = (shifted(a, o, within) for a in sides[int(mirrored)])
        weight *= offered
        total += weight * (copied + lacking)
        weights += weight
        np.maximum(trust, agreed, out=trust, where=weight > 0)
    return total / np.maximum(weights, 1e-6), trust


def guess(values: Values, hole: Mask) -> Values:
    """Fill a hole with what repeats, and smoothly where nothing does.

    What the copies miss of the known texels, mostly shade, is carried into the hole by
    a membrane of its own. Deep inside a hole at the foot, all is darkened.
    """
    made = flow(values, hole)
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
    return made * darkening(hole)
