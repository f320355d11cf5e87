"""A block's cuboids put on their elevations: one mesh, one atlas, one GLB.

In: `Settled` and the finished elevations that it wears. Out: GLBs, fine and coarse.
Paper: section 3.5. Open `model` first.
"""

from nostalgin_core.model.facts import address, table
from nostalgin_core.model.massing import Volumes, massing
from nostalgin_core.model.model import model
from nostalgin_core.model.picture import ImageFormat, legend
from nostalgin_core.model.rights import Rights

__all__ = [
    "ImageFormat",
    "Rights",
    "Volumes",
    "address",
    "legend",
    "massing",
    "model",
    "table",
]
