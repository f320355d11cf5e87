"""Facades find their fronts, and a block's cuboids rise in order round its rings.

In: `Front`s and `Seen` facades, numbers alone. Out: `Settled`, with its `Block`.
Paper: section 3.5 and algorithm 2. Open `settle` first, then `chain`.
"""

from nostalgin_core.block.block import FALLBACK_GAP_M, cutting_streets
from nostalgin_core.block.settle import Settled, raised, settle

__all__ = ["FALLBACK_GAP_M", "Settled", "cutting_streets", "raised", "settle"]
