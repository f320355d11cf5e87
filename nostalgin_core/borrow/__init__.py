"""What a front's own photograph does not show, borrowed from its neighbours'.

In: the elevation that a front wears, and elevations of the same front from other
photographs. Out: `Borrowed`, the elevation with its holes filled as far as another
camera saw them, and which photograph each such texel comes from. Open `borrow` first.
"""

from nostalgin_core.borrow.borrow import Borrowed, Lender, borrow, over

__all__ = ["Borrowed", "Lender", "borrow", "over"]
