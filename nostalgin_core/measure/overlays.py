"""Learn the overlay that photographs share from them alone, or tell that there is none.

Laid over each other, streets even out and an overlay stays. The photographs are halved,
each half's mean of what stands out is told, and the halves are correlated over all
shifts of one against the other: what they share of noise is nothing, so a peak at no
shift is an overlay, and peaks at others are the steps in which it repeats. Its tile is
measured on each half (`watermarks.measured`): the tiles have to agree, and each has to
be found in the other half's photographs. An overlay that does not repeat is told, not
learnt: too little of it lies in one photograph to be found there.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import cv2
import numpy as np
from jaxtyping import Float, UInt8
from scipy.interpolate import CubicSpline

from nostalgin_core.arrays import Gray
from nostalgin_core.measure import watermarks
from nostalgin_core.rectify import watermark
from nostalgin_core.rectify.watermark import WIDE_PX, Tile, Watermark

LEAST: Final = 20  # photographs: of fewer, halves tell too little
WIDEST_PX: Final = 1120  # to which wider photographs are shrunk
TALLEST: Final = 1.6  # of widths: what is beyond is left out
NEAR: Final = 8 / WIDE_PX  # of the width: round a place, where its tone is told
LARGEST: Final = 6.0  # standard deviations: an edge that all share speaks no louder
LEAST_PEAK: Final = 10.0  # standard deviations that a shared overlay stands out
RING: Final = (5, 16)  # px: round a peak, where its foot is
LEAST_STEP: Final = 0.04  # of the width: the blocks of JPEG repeat in smaller steps
REPEATED: Final = 0.45  # of the peak at no shift: what peaks of an overlay's steps have
FINELY: Final = np.linspace(-8e-3, 8e-3, 321)  # round the first peak's step
NEARLY: Final = 0.8  # of what stands out most
OVERLAP: Final = 0.15  # of the frame: where less overlaps, nothing is told
LEAST_AGREEMENT: Final = 0.5  # correlation of both halves' tiles
LEAST_BORNE: Final = 0.5  # of the photographs
MIDDLE, TOP, BOTTOM = 0.5, 0.0, 1.0  # from where rows are counted, over the height
TONE: Final = 128.0  # at which an overlay is looked at

Copy = UInt8[np.ndarray, "_ _"]  # of any size, beside others
Map = Float[np.ndarray, "h w"]
Lags = Float[np.ndarray, "down across"]  # a map's shifts, none in the middle


class Standing(NamedTuple):
    """What stands out at each place of a photograph, and what it weighs."""

    over: np.ndarray
    weight: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class Learnt:
    """An overlay, and how sure it is; falsy where the photographs share none."""

    photos: int
    peak: float  # of the halves' correlation at no shift, in standard deviations
    agreement: float = 0.0  # correlation of the tiles of both halves
    borne: int = 0  # photographs in which the other half's tile is found
    mark: Watermark | None = None
    why: str = ""  # there is none

    def __bool__(self) -> bool:
        """Tell whether there is an overlay."""
        return self.mark is not None


class Layout(NamedTuple):
    """Where an overlay lies: from which row, and in which steps."""

    from_top: float
    step_px: tuple[float, float] | None  # to the right and down, if it repeats


def learnt(images: Sequence[Copy], words: str) -> Learnt:
    """Learn the overlay that photographs share; what it says is told by people."""
    count = len(images)
    if count < LEAST:
        return Learnt(count, 0.0, why=f"{count} photographs, and {LEAST} are needed")
    wide = min(WIDEST_PX, int(np.median([one.shape[1] for one in images])) // 2 * 2)
    images = [scaled(one, wide) for one in images]
    peak, layout = laid_out(images)
    if peak < LEAST_PEAK:
        why = f"nothing lies in the same place of both halves ({peak:.1f} sd)"
        return Learnt(count, peak, why=why)
    if layout.step_px is None:
        why = (
            "what they share does not repeat to the right and down, or they share edges"
        )
        return Learnt(count, peak, why=why)
    halves = images[0::2], images[1::2]
    one, other = (measured(half, words, layout) for half in halves)
    agreement = alike(one, other)
    borne = found(halves[0], other) + found(halves[1], one)
    told = {"photos": count, "peak": peak, "agreement": agreement, "borne": borne}
    if agreement < LEAST_AGREEMENT:
        why = f"what each half shows is not the same (correlation {agreement:.2f})"
        return Learnt(**told, why=why)
    if borne < LEAST_BORNE * count:
        return Learnt(**told, why=f"only {borne} of {count} bear what they share")
    return Learnt(**told, mark=measured(images, words, layout))


def scaled(image: Gray, wide: int) -> UInt8[np.ndarray, "rows columns"]:
    """Bring a photograph to a width, and cut what is far too tall."""
    h, w = image.shape
    how = cv2.INTER_AREA if w > wide else cv2.INTER_CUBIC
    size = wide, max(1, round(h * wide / w))
    image = image if w == wide else cv2.resize(image, size, interpolation=how)
    spare = max(0, image.shape[0] - round(TALLEST * wide))
    return image[spare // 2 : image.shape[0] - (spare - spare // 2)]


def laid_out(images: Sequence[Copy]) -> tuple[float, Layout]:
    """Tell how far what the halves share stands out, and where it lies."""
    tall = max(one.shape[0] for one in images)
    own = [standing_out(one) for one in images]
    even = len({one.shape for one in images}) == 1
    told = []
    for from_top in (MIDDLE,) if even else (MIDDLE, TOP, BOTTOM):
        halves = [meant(own[n::2], tall, from_top) for n in (0, 1)]
        across = correlated(*halves)
        told.append((peak_of(across), from_top, across))
    peak, from_top, across = max(told, key=lambda one: one[0])
    return peak, Layout(from_top, steps(across, images[0].shape[1]))


def standing_out(image: Gray) -> Standing:
    """Tell by how much each place stands out from round about, and what that weighs."""
    tones = image.astype(np.float32)
    near = NEAR * image.shape[1]
    over = tones - cv2.GaussianBlur(tones, (0, 0), near)
    spread = cv2.GaussianBlur(over**2, (0, 0), near) + np.float32(watermark.GRAIN)
    weight = np.where(np.abs(over) > watermark.OUTLIER, 0, 1 / spread)
    return Standing(over, weight.astype(np.float32))


def meant(own: Sequence[Standing], tall: int, from_top: float) -> Map:
    """Mean what stands out in many photographs, in standard deviations of the mean."""
    sums = np.zeros((2, tall, own[0].over.shape[1]))
    for over, weight in own:
        top = round((tall - over.shape[0]) * from_top)
        rows = slice(top, top + over.shape[0])
        sums[0, rows] += weight * over
        sums[1, rows] += weight
    mean = sums[0] / np.sqrt(np.maximum(sums[1], 1e-9))
    return np.clip(mean, -LARGEST, LARGEST)


def correlated(one: Map, other: Map) -> Lags:
    """Correlate two maps over all shifts; no shift is in the middle."""
    h, w = one.shape
    first, second = (np.fft.rfft2(each, (2 * h, 2 * w)) for each in (one, other))
    sums = np.fft.fftshift(np.fft.irfft2(first.conj() * second, (2 * h, 2 * w)))
    rows, columns = (n - np.abs(np.arange(-n, n)) for n in (h, w))
    shared = np.outer(rows, columns) / (h * w)
    norm = np.sqrt((one**2).sum() * (other**2).sum())
    across = sums / np.maximum(shared, OVERLAP) / max(float(norm), 1e-9)
    return np.where(shared < OVERLAP, 0.0, across)


def peak_of(across: Lags) -> float:
    """Tell how far no shift stands out of its foot, over how far other shifts do."""
    tops = risen(across)
    h, w = across.shape[0] // 2, across.shape[1] // 2
    elsewhere = tops[across != 0]
    spread = 1.4826 * float(np.median(np.abs(elsewhere - np.median(elsewhere))))
    return float(tops[h - 1 : h + 2, w - 1 : w + 2].max()) / max(spread, 1e-9)


def risen(across: Lags) -> Lags:
    """Take away from each place of a map the mean of a ring round it."""
    inner, outer = (2 * one + 1 for one in RING)
    whole = cv2.boxFilter(across, -1, (outer, outer), normalize=False)
    within = cv2.boxFilter(across, -1, (inner, inner), normalize=False)
    return across - (whole - within) / (outer**2 - inner**2)


def steps(across: Lags, wide: int) -> tuple[float, float] | None:
    """Find in which steps to the right and down an overlay repeats, if it does."""
    tops = risen(across)
    h, w = across.shape[0] // 2, across.shape[1] // 2
    right = (tops[h - 1 : h + 2, w:] + tops[h - 1 : h + 2, w:0:-1]).max(axis=0) / 2
    down = (tops[h:, w - 1 : w + 2] + tops[h:0:-1, w - 1 : w + 2]).max(axis=1) / 2
    found = [stepped(line, LEAST_STEP * wide) for line in (right, down)]
    if found[0] is None or found[1] is None:
        return None
    return found[0], found[1]


def stepped(line: Float[np.ndarray, " n"], least: float) -> float | None:
    """Find the step of a line's peaks: the least at whose multiples as much stands out.

    Letters that are like each other stand out at other shifts, and less at twice these.
    """
    ends = line[1:-1]
    high = (ends >= line[:-2]) & (ends >= line[2:]) & (ends > REPEATED * line[0])
    peaks = [int(at) + 1 for at in np.flatnonzero(high) if at + 1 >= least]
    if not peaks:
        return None
    smooth = CubicSpline(np.arange(len(line)), line)
    scored = []
    for at in peaks:
        tried = refined(line, at) * (1 + FINELY)
        count = max(1, int(len(line) * (1 - OVERLAP) / tried[-1]))
        mean = smooth(np.outer(tried, np.arange(1, count + 1))).mean(axis=1)
        scored.append((float(mean.max()), float(tried[np.argmax(mean)])))
    enough = NEARLY * max(scored)[0]
    return next(step for score, step in scored if score >= enough)


def refined(line: Float[np.ndarray, " n"], at: int) -> float:
    """Set a peak between samples, by the parabola through three."""
    before, here, after = (float(line[at + n]) for n in (-1, 0, 1))
    bend = before - 2 * here + after
    return at + (0.5 * (before - after) / bend if bend < 0 else 0.0)


def measured(images: Sequence[Copy], words: str, layout: Layout) -> Watermark:
    """Measure an overlay's tile on photographs of one width, a cell half a pixel wide.

    Raises:
        ValueError: if it does not repeat.
    """
    if layout.step_px is None:
        raise ValueError(f"no steps: {layout}")
    wide, (across, down) = images[0].shape[1], layout.step_px
    blank = np.zeros((round(2 * down), round(2 * across)), np.float32)
    step = across / wide, down / wide
    mark = Watermark(words, blank, blank, step, layout.from_top, wide)
    return watermarks.measured(lambda: images, mark)


def visible(mark: Watermark) -> Tile:
    """Tell what a mark changes of a middling tone."""
    return mark.adds - mark.covers * np.float32(TONE)


def alike(one: Watermark, other: Watermark) -> float:
    """Correlate what two marks of one layout change."""
    first, second = visible(one), visible(other)
    norm = float(np.sqrt((first**2).sum() * (second**2).sum()))
    return float((first * second).sum()) / norm if norm else 0.0


def found(images: Sequence[Copy], mark: Watermark) -> int:
    """Count the photographs that bear a mark."""
    return sum(watermark.fit(one, mark).borne for one in images)
