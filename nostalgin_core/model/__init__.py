"""A block's cuboids put on their elevations: one mesh, one atlas, one GLB.

In: `Settled` and the finished elevations that it wears. Out: a GLB's bytes, its `Mesh`.
Paper: section 3.5. Open `model` first.
"""

from nostalgin_core.model.facts import address, table
from nostalgin_core.model.model import model
from nostalgin_core.model.picture import legend

__all__ = ["address", "legend", "model", "table"]
