"""What was hidden is filled: a guess from what repeats, then a network, slice by slice.

In: an `Elevation` with holes, and a network. Out: the same, filled and marked.
Paper: sections 3.4 and 4.3. Open `inpaint` first.
"""

from nostalgin_core.inpaint.inpaint import holes, inpaint
from nostalgin_core.inpaint.rim import kept, rim

__all__ = ["holes", "inpaint", "kept", "rim"]
