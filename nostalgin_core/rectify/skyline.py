"""Where an elevation ends: at the roof in its silhouette, else in straight lines.

A matte follows whatever hides the front: beside a neighbour and at the ground its edge
is torn, though the wall there ends in a straight line, the quad's. Only over the roof
is there sky. So what is no front counts as open where it lies over the roof line, which
is the front's first texel in each column, once the tears are closed: narrow clefts of
great depth, and narrow strips along the sides.
"""

from typing import Final

import numpy as np
from jaxtyping import Int
from scipy import ndimage

from nostalgin_core.arrays import Mask

NARROW: Final = 0.1  # of the front's width: what is wider is a lower part of the house
DEEP: Final = 0.15  # of its height: a shallower cleft stands between dormers or gables
DEEP_AT_SIDE: Final = 0.05  # a strip along a side that is shallower rounds the roof

LOWEST: Final = 0.85  # of its height: a column that begins lower shows no front at all

Rows = Int[np.ndarray, " w"]


def over_roof(front: Mask) -> Mask:
    """Tell which texels of an elevation lie over its front's roof line."""
    height = len(front)
    roof = mended(np.where(front.any(axis=0), front.argmax(axis=0), height), height)
    return ~front & (np.arange(height)[:, None] < roof)


def mended(roof: Rows, height: int) -> Rows:
    """Close the tears of a roof line, given as the first row of each column."""
    there = np.flatnonzero(roof <= LOWEST * height)
    if not len(there):
        return np.zeros_like(roof)
    between = (there[1:] + there[:-1]) / 2
    roof = roof[there[np.searchsorted(between, np.arange(len(roof)))]]  # the nearest
    cells = 2 * round(NARROW * len(roof) / 2) + 1
    inner = closed(roof, cells, beyond=height)
    outer = closed(roof, cells, beyond=0)
    roof = np.where(roof - inner > DEEP * height, inner, roof)
    return np.where(inner - outer > DEEP_AT_SIDE * height, outer, roof)


def closed(roof: Rows, cells: int, *, beyond: int) -> Rows:
    """Raise what lies lower than all round it over less than so many columns.

    `beyond` is the row at which the roof is taken to lie on either side of the front.
    """
    padded = np.pad(roof, cells, constant_values=beyond)
    higher = ndimage.minimum_filter1d(padded, cells)
    return ndimage.maximum_filter1d(higher, cells)[cells:-cells]
