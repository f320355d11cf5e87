"""Blocks take their places by outlines, points or the streets between them.

In: outlines and fronts of each block, and what is told of its place on the globe. Out:
its `Move`, and a tileset. Paper: section 3.5, there "a trivial extension". Open `city`
first, then `anchor`.
"""

from nostalgin_core.city.anchor import Anchor, Settled, anchored, gap_m, overlaps
from nostalgin_core.city.city import places
from nostalgin_core.city.globe import bearing_of, on_globe
from nostalgin_core.city.islands import islands
from nostalgin_core.city.plot import Move, Plot, carried, plot
from nostalgin_core.city.tileset import Place, Tile, ecef_from_enu
from nostalgin_core.city.tree import tree
from nostalgin_core.city.united import united

__all__ = [
    "Anchor",
    "Move",
    "Place",
    "Plot",
    "Settled",
    "Tile",
    "anchored",
    "bearing_of",
    "carried",
    "ecef_from_enu",
    "gap_m",
    "islands",
    "on_globe",
    "overlaps",
    "places",
    "plot",
    "tree",
    "united",
]
