"""Take an archive's known watermark out of a photo's tones, where the photo bears it.

An archive that lays its name over the copies it hands out blends one tile with them,
over and over (Dekel et al., On the Effectiveness of Visible Watermarks, CVPR 2017,
equation 1, with one tile for all of a collection):

    J = (1 - a) I + b

`J` is the copy, `I` the photograph, `a` how much of it the mark covers, and `b` what
the mark adds in gray levels; the tile repeats in steps that are shares of the copy's
width, from the middle of the copy, its head or its foot. `a` and `b` were measured on
many copies (`measure.watermarks`), so a copy that bears them can be solved for `I`
(`cleared`). Texels are solved, not painted: no more of the photograph is hidden than
`a`, which is less than a third of New York's.
"""

from dataclasses import dataclass
from typing import Final, NamedTuple

import cv2
import numpy as np
from jaxtyping import Float, UInt8

from nostalgin_core.arrays import Gray, Mask

WIDE_PX: Final = 560  # of the copies that New York's tile was measured on
LEAST_PX: Final = 280  # of a photo's width: in a narrower one nobody reads the mark
NEAR_PX: Final = 2.5  # round a letter: where its background's tone is told
CLEAR: Final = 0.012  # of `a`, and of `b` over white: below, a pixel is background
WHITE: Final = 255.0
EDGE: Final = 1e-6  # of a cell: what lies between two is always in the second
GRAIN: Final = 3.0  # variance of a scan's grain, in square gray levels
OUTLIER: Final = 45.0  # gray levels: what differs more is an edge of the street
STRENGTHS: Final = (0.6, 1.4)  # of a copy's mark over the known one's
LEAST_SURE: Final = 10.0  # standard deviations over the same mark laid elsewhere
SHIFTS: Final = 9  # either way, of the tile: where the mark is not

Tile = Float[np.ndarray, "th tw"]
Field = Float[np.ndarray, "h w"]


@dataclass(frozen=True, slots=True, eq=False)
class Watermark:
    """One tile of a known watermark."""

    words: str  # what it says: to be said in its place
    covers: Tile  # a
    adds: Tile  # b, in gray levels
    step: tuple[float, float]  # to the right and down, over the photo's width
    from_top: float = 0.5  # of the height: the row from which tiles are counted
    wide_px: int = WIDE_PX  # of the copies that it was measured on
    near_px: float = NEAR_PX  # of a copy `WIDE_PX` wide: farther for wider strokes
    shift: tuple[float, float] = (0.0, 0.0)  # of a copy's tiles, in tiles


class Sums(NamedTuple):
    """What a photo says of a mark, summed up over all tiles, a cell a place of one.

    Of weights, and weights times tone, tone squared, difference, difference and tone.
    """

    w: Tile
    wt: Tile
    wtt: Tile
    wr: Tile
    wtr: Tile


class Fit(NamedTuple):
    """How strongly a photo bears a mark, and how surely: see `fit`."""

    strength: float  # over the known mark's
    surely: float  # standard deviations

    @property
    def borne(self) -> bool:
        """Tell whether the photo bears the mark."""
        low, high = STRENGTHS
        return low < self.strength < high and self.surely > LEAST_SURE


def fit(image: Gray, mark: Watermark) -> Fit:
    """Measure how strongly an image bears a mark.

    The least squares of what lies over the letters' background, J - T = g (b - a T),
    with `T` the tone beside the letters. Laid where it can't be, the mark fits as it
    does by chance, so its strengths there tell how surely `g` is not by chance.
    """
    h, w = image.shape
    if w < LEAST_PX or h < LEAST_PX:
        return Fit(0.0, 0.0)
    image = shrunk(image, mark)
    sums = summed(image, background(mark, image.shape), mark)
    here = strength(sums, mark, (0, 0))
    there = [strength(sums, mark, shift) for shift in elsewhere(mark)]
    spread = float(np.std(there))
    return Fit(here, (here - float(np.mean(there))) / spread if spread else 0.0)


def shrunk(image: Gray, mark: Watermark) -> UInt8[np.ndarray, "rows columns"]:
    """Shrink an image that is wider than the copies that a mark was measured on."""
    (h, w), wide = image.shape, mark.wide_px
    if w <= wide:
        return image
    size = wide, max(LEAST_PX, round(h * wide / w))
    return cv2.resize(image, size, interpolation=cv2.INTER_AREA)


def elsewhere(mark: Watermark) -> list[tuple[int, int]]:
    """List shifts of a tile, by cells, that lay no line of its letters on another."""
    th, tw = mark.covers.shape
    down = np.linspace(0.2, 0.8, SHIFTS) * th
    across = np.arange(SHIFTS) * 4 % SHIFTS / SHIFTS * tw
    return [(int(y), int(x)) for y, x in zip(down, across, strict=True)]


def strength(sums: Sums, mark: Watermark, shift: tuple[int, int]) -> float:
    """Fit a mark's strength, the tile shifted by so many cells down and across."""
    a, b = (np.roll(one, shift, (0, 1)) for one in (mark.covers, mark.adds))
    over = (b * sums.wr - a * sums.wtr).sum()
    under = (b * b * sums.w - 2 * a * b * sums.wt + a * a * sums.wtt).sum()
    return float(over / under) if under > 0 else 0.0


def background(mark: Watermark, shape: tuple[int, ...]) -> Mask:
    """Tell which pixels of an image no letter of a mark changes."""
    covers, adds = laid(mark, shape)
    return (np.abs(covers) < CLEAR) & (np.abs(adds) < CLEAR * WHITE)


class Standing(NamedTuple):
    """What stands out of the tone beside letters, at each place of an image."""

    weight: Field
    tone: Field
    over: Field


def standing(image: Gray, bare: Mask, *, near_px: float) -> Standing:
    """Tell what stands out of an image's background; even places weigh most."""
    tones = image.astype(np.float32)
    shown = bare.astype(np.float32)
    near = near_px * image.shape[1] / WIDE_PX

    def round_about(values: np.ndarray) -> np.ndarray:
        return cv2.GaussianBlur(values, (0, 0), near)

    known = round_about(shown) + np.float32(1e-3)
    tone = round_about(tones * shown) / known
    over = tones - tone
    weight = 1 / (round_about((over * shown) ** 2) / known + np.float32(GRAIN))
    weight[np.abs(over) > OUTLIER] = 0
    return Standing(weight, tone, over)


def summed(image: Gray, bare: Mask, mark: Watermark) -> Sums:
    """Sum up over all tiles what an image says of a mark."""
    weight, tone, over = standing(image, bare, near_px=mark.near_px)
    cells = cell_of(mark, image.shape)
    values = (weight, weight * tone, weight * tone**2, weight * over)
    return Sums(
        *(
            np.bincount(cells, one.ravel(), mark.covers.size).reshape(mark.covers.shape)
            for one in (*values, weight * over * tone)
        )
    )


def places(mark: Watermark, shape: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Give the tile's column of each column of an image, and its row of each row."""
    (h, w), (th, tw) = shape, mark.covers.shape
    right, below = mark.shift
    across = (np.arange(w) - (w - 1) / 2) / (mark.step[0] * w) + right
    down = (np.arange(h) - (h - 1) * mark.from_top) / (mark.step[1] * w) + below
    return across % 1 * tw, down % 1 * th


def cell_of(mark: Watermark, shape: tuple[int, ...]) -> np.ndarray:
    """Number the tile's cell that each pixel lies in, row by row."""
    found = zip(places(mark, shape), mark.covers.shape[::-1], strict=True)
    across, down = ((one + EDGE).astype(np.intp) % n for one, n in found)
    return (down[:, None] * mark.covers.shape[1] + across).ravel()


def laid(mark: Watermark, shape: tuple[int, ...]) -> tuple[Field, Field]:
    """Lay a mark's tiles over an image of a size: what they cover, and what they add.

    A pixel of a wide photo is smaller than a cell, and is interpolated.
    """
    grid = [one.astype(np.float32) - 0.5 for one in places(mark, shape)]
    columns, rows = np.meshgrid(grid[0] + 2, grid[1] + 2)  # over the padding

    def over(tile: Tile) -> Field:
        padded = np.pad(tile.astype(np.float32), 2, mode="wrap")
        return cv2.remap(padded, columns, rows, cv2.INTER_CUBIC)

    return over(mark.covers), over(mark.adds)
