"""Take an archive's known watermark out of a photo's tones, where the photo bears it.

An archive that lays its name over the copies it hands out blends one tile with them,
over and over (Dekel et al., On the Effectiveness of Visible Watermarks, CVPR 2017,
equation 1, with one tile for all of a collection):

    J = (1 - a) I + b

`J` is the copy, `I` the photograph, `a` how much of it the mark covers, and `b` what
the mark adds in gray levels; the tile repeats in steps that are shares of the copy's
width, from the middle of the copy. `a` and `b` were measured on many copies
(`measure.watermarks`), so a copy that bears them can be solved for `I`. Any other photo
is left as it is, bit by bit. Texels are solved, not painted: no more of the photograph
is hidden than `a`, which is less than a third.
"""

from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.records import Photo

WIDE_PX: Final = 560  # to which wider photos are shrunk to be looked at
FINEST_PX: Final = 720  # of a width: a finer copy shows edges that the tile has not
LEAST_PX: Final = 280  # of a photo's width: in a narrower one nobody reads the mark
NEAR_PX: Final = 2.5  # round a letter: where its background's tone is told
CLEAR: Final = 0.012  # of `a`, and of `b` over white: below, a pixel is background
WHITE: Final = 255.0
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


def unmarked(photo: Photo, mark: Watermark | None) -> tuple[Photo, str]:
    """Take a mark out of a photo that bears it, and give its words; else give neither.

    A copy much finer than those that the tile was measured on keeps its mark, which
    would leave a ghost. A tone that the solution takes beyond white or black ends
    there.
    """
    fine = photo.image.shape[1] > FINEST_PX
    if mark is None or fine or not fit(photo.image, mark).borne:
        return photo, ""
    covers, adds = laid(mark, photo.image.shape)
    solved = (photo.image - adds) / (1 - covers)
    image = np.clip(np.rint(solved), 0, 255).astype(np.uint8)
    return replace(photo, image=image), mark.words


def fit(image: Gray, mark: Watermark) -> Fit:
    """Measure how strongly an image bears a mark.

    The least squares of what lies over the letters' background, J - T = g (b - a T),
    with `T` the tone beside the letters. Laid where it can't be, the mark fits as it
    does by chance, so its strengths there tell how surely `g` is not by chance.
    """
    h, w = image.shape
    if w < LEAST_PX or h < LEAST_PX:
        return Fit(0.0, 0.0)
    if w > WIDE_PX:
        size = WIDE_PX, max(LEAST_PX, round(h * WIDE_PX / w))
        image = cv2.resize(image, size, interpolation=cv2.INTER_AREA)
    sums = summed(image, background(mark, image.shape), mark)
    here = strength(sums, mark, (0, 0))
    there = [strength(sums, mark, shift) for shift in elsewhere(mark)]
    spread = float(np.std(there))
    return Fit(here, (here - float(np.mean(there))) / spread if spread else 0.0)


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


def summed(
    image: Gray, bare: Mask, mark: Watermark, *, near_px: float = NEAR_PX
) -> Sums:
    """Sum up over all tiles what an image says of a mark; even places say most."""
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
    across = (np.arange(w) - (w - 1) / 2) / (mark.step[0] * w) % 1 * tw
    down = (np.arange(h) - (h - 1) / 2) / (mark.step[1] * w) % 1 * th
    return across, down


def cell_of(mark: Watermark, shape: tuple[int, ...]) -> np.ndarray:
    """Number the tile's cell that each pixel lies in, row by row."""
    across, down = (one.astype(np.intp) for one in places(mark, shape))
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
