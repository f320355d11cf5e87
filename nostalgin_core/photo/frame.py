"""The exposed frame is what the camera saw; round it, a scan shows unexposed film.

On a positive the film's border is black or nearly so, even along its whole length, and
ends at a sharp straight edge, unlike a dark wall or a night sky. A print whose margin
was cut has none, and then the frame is the whole image.
"""

from functools import partial

import numpy as np

from nostalgin_core.arrays import Gray
from nostalgin_core.records import Box

_SPAN = (0.08, 0.92)  # part of each line that counts: the frame's corners are rounded


def exposed(
    image: Gray,
    *,
    depth: float = 0.08,
    darkest: float = 72.0,
    step: float = 24.0,
    even: float = 0.8,
    left: float = 0.4,
    edge: float = 0.012,
) -> Box:
    """Find the exposed frame, one side at a time; the whole image where none is found.

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
    h, w = image.shape
    rows = image[:, int(_SPAN[0] * w) : int(np.ceil(_SPAN[1] * w))]
    columns = image[int(_SPAN[0] * h) : int(np.ceil(_SPAN[1] * h))].T

    border = partial(
        _border,
        depth=depth,
        darkest=darkest,
        step=step,
        even=even,
        left=left,
        edge=edge,
    )
    x0, y0 = border(columns), border(rows)
    x1, y1 = w - border(columns[::-1]), h - border(rows[::-1])
    return Box(x0, y0, x1, y1)


def _border(
    lines: Gray,
    *,
    depth: float,
    darkest: float,
    step: float,
    even: float,
    left: float,
    edge: float,
) -> int:
    """Count the lines of border, from the outermost one inwards."""
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
    gaps = np.flatnonzero(np.diff(dark) > 1)
    last = int(dark[gaps[0]] if len(gaps) else dark[-1])
    outside = np.flatnonzero(share[last : last + reach + 1] < left)
    return last + int(outside[0]) if len(outside) else 0
