"""The exposed frame is what the camera saw; round it, a scan shows film or paper.

On a positive the film's border is black or nearly so, even along its whole length, and
ends at a sharp straight edge, unlike a dark wall or a night sky. A print's or a
postcard's border is as even and as light as its paper, and often wider below, where
its caption stands. A sky or a snowy street may be that light at one side, or hide where
the paper begins; so paper is believed where three sides show it, in one tone. A print
whose margin was cut has none, and then the frame is the whole image.
"""

from collections.abc import Sequence
from functools import partial
from typing import Final

import numpy as np
from jaxtyping import UInt8

from nostalgin_core.arrays import Gray
from nostalgin_core.records import Box, Photo

_SPAN = (0.08, 0.92)  # part of each line that counts: the frame's corners are rounded
WHITE: Final = 255
SIDES: Final = 3  # of four that must show paper
SAME: Final = 24.0  # gray levels between the paper's tones along its sides


def exposed(image: Gray) -> Box:
    """Find the exposed frame within film and paper, the whole image if it has neither.

    Film is sought first: it lies round the picture, or round a print that was filmed.
    """
    x0, y0, x1, y1 = filmed(image)
    left, above, right, below = paper(image[y0:y1, x0:x1])
    return Box(x0 + left, y0 + above, x1 - right, y1 - below)


def framed(key: str, image: Gray) -> Photo:
    """Make a photo of gray pixels, with its frame, and its sheet if it is a print."""
    frame, sheet = exposed(image), filmed(image)
    return Photo(key, image, frame, None if sheet == frame else sheet)


def filmed(
    image: Gray,
    *,
    depth: float = 0.08,
    darkest: float = 72.0,
    step: float = 24.0,
    even: float = 0.8,
    left: float = 0.4,
    edge: float = 0.012,
) -> Box:
    """Find what lies within film, one side at a time; all where none is found.

    A line is *dark* if at least `even` of its pixels lie less than `step` gray levels
    above the darkest line's median. A side has a border where dark lines run from near
    the image's edge (a sliver of the next frame may lie outside) to a sharp edge: at
    most `edge` of the image's size further on, less than `left` of a line is that dark.

    Args:
        image: The photo; 0 is black.
        depth: The widest border, as a share of the image's height or width. The tax
            photographs' widest is 0.04.
        darkest: The brightest median of a border, in gray levels: fogged film reaches
            50.
        step: How much brighter than its median a border's pixel may be.
        even: The share of dark pixels that makes a line of border; flares and hole
            punches take the rest.
        left: The share below which a line has left the border. It lies below a half
            because the film's mask is often turned by half a degree.
        edge: The widest edge, and the widest sliver outside, as a share of the image's
            height or width.
    """
    film = partial(_border, darkest=darkest, step=step, even=even, left=left, edge=edge)
    return _within(image, [film(lines, depth=depth) for lines in _lines(image)])


def paper(
    image: Gray,
    *,
    depth: float = 0.12,
    caption: float = 0.3,
    written: float = 0.06,
    lightest: float = 150.0,
    step: float = 14.0,
    even: float = 0.8,
    left: float = 0.4,
    edge: float = 0.012,
) -> tuple[int, int, int, int]:
    """Measure a print's light border: its left, upper, right and lower pixels.

    All are 0 unless `SIDES` show paper of one tone.

    Args:
        image: The photo within its film's border.
        depth: The widest border, as a share of the image's height or width.
        caption: The widest below the picture.
        written: The tallest line of letters in it.
        lightest: The darkest median of paper, in gray levels.
        step: How much darker than its median paper may be.
        even: The share of a line that must be so light; letters take the rest.
        left: The share below which a line has left the border.
        edge: The widest edge, as a share of the image's height or width.
    """
    negative = WHITE - image
    border = partial(
        _border, darkest=WHITE - lightest, step=step, even=even, left=left, edge=edge
    )
    deep = (depth, depth, depth, caption)
    letters = (0.0, 0.0, 0.0, written)
    wide = [
        border(lines, depth=most, gap=gap)
        for lines, most, gap in zip(_lines(negative), deep, letters, strict=True)
    ]
    tones = [
        float(np.median(lines[:most]))
        for lines, most in zip(_lines(image), wide, strict=True)
        if most
    ]
    if len(tones) < SIDES or max(tones) - min(tones) > SAME:
        return 0, 0, 0, 0
    return wide[0], wide[1], wide[2], wide[3]


def _lines(image: Gray) -> list[UInt8[np.ndarray, "_ _"]]:
    """Return the image's lines from its left, upper, right and lower side inwards."""
    h, w = image.shape
    rows = image[:, int(_SPAN[0] * w) : int(np.ceil(_SPAN[1] * w))]
    columns = image[int(_SPAN[0] * h) : int(np.ceil(_SPAN[1] * h))].T
    return [columns, rows, columns[::-1], rows[::-1]]


def _within(image: Gray, wide: Sequence[int]) -> Box:
    """Cut what is so many lines wide off the four sides."""
    h, w = image.shape
    return Box(wide[0], wide[1], w - wide[2], h - wide[3])


def _border(
    lines: Gray,
    *,
    depth: float,
    darkest: float,
    step: float,
    even: float,
    left: float,
    edge: float,
    gap: float = 0.0,
) -> int:
    """Count the lines of border, from the outermost one inwards, over gaps in it."""
    n = len(lines)
    lines = lines[: max(3, int(depth * n))]
    reach = max(6, round(edge * n))
    level = float(np.median(lines, axis=1).min())
    if level > darkest:
        return 0
    share = (lines <= level + step).mean(axis=1)
    dark = np.flatnonzero(share >= even)
    if len(dark) == 0 or dark[0] > reach:
        return 0
    gaps = np.flatnonzero(np.diff(dark) > 1 + gap * n)
    last = int(dark[gaps[0]] if len(gaps) else dark[-1])
    outside = np.flatnonzero(share[last : last + reach + 1] < left)
    return last + int(outside[0]) if len(outside) else 0
