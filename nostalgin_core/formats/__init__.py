"""A block's published GLB, read again and written as other programs want it.

In: the bytes of a GLB, and the block's record. Out: CityJSON, OBJ, GeoJSON and texts.
Open `shown` first.
"""

from nostalgin_core.formats.cityjson import feature, header, land
from nostalgin_core.formats.geojson import footprint
from nostalgin_core.formats.iiif import Canvas, canvas, presentation
from nostalgin_core.formats.located import Ground, of_globe, of_plane
from nostalgin_core.formats.obj import archive
from nostalgin_core.formats.shown import Shell, Shown, Unreadable, png, read, tinted

__all__ = [
    "Canvas",
    "Ground",
    "Shell",
    "Shown",
    "Unreadable",
    "archive",
    "canvas",
    "feature",
    "footprint",
    "header",
    "land",
    "of_globe",
    "of_plane",
    "png",
    "presentation",
    "read",
    "tinted",
]
