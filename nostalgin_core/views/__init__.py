"""Whether two elevations show one front, and how they lie over each other.

In: elevations, as pictures with what a camera saw of them. Out: the homography from one
to the other, and the probability that both are of one front. Open `overlay` first.
"""

from nostalgin_core.views.likeness import likeness, probability
from nostalgin_core.views.marks import Marks, View, marks
from nostalgin_core.views.overlay import overlay

__all__ = ["Marks", "View", "likeness", "marks", "overlay", "probability"]
