"""Which front each facade shows, and how views of one front lie over each other.

In: elevations, as pictures with what a camera saw of them, and where they stand in
their photographs. Out: the homography from one to the other, the probability that both
are of one front, and a `Claim` for each facade that shows a front of its ring. Open
`claims` first, then `order` and `overlay`.
"""

from nostalgin_core.views.agreement import Alike
from nostalgin_core.views.claims import Claim, claimed, claims, heard, owned
from nostalgin_core.views.compare import compared
from nostalgin_core.views.likeness import likeness, probability
from nostalgin_core.views.marks import Marks, View, marks, seen_on, turned
from nostalgin_core.views.overlay import overlay
from nostalgin_core.views.stretch import Stretch, stretch

__all__ = [
    "Alike",
    "Claim",
    "Marks",
    "Stretch",
    "View",
    "claimed",
    "claims",
    "compared",
    "heard",
    "likeness",
    "marks",
    "overlay",
    "owned",
    "probability",
    "seen_on",
    "stretch",
    "turned",
]
