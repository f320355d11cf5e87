"""Blocks take their places by the streets between them, as 3D Tiles.

In: outlines and fronts of each block. Out: its `Move`, and a tileset.
Paper: section 3.5, there "a trivial extension". Open `city` first.
"""

from nostalgin_core.city.city import Move, places, plot
from nostalgin_core.city.tileset import Place, Tile, ecef_from_enu
from nostalgin_core.city.tree import tree

__all__ = ["Move", "Place", "Tile", "ecef_from_enu", "places", "plot", "tree"]
