"""Each front gets a soft outline, and what stands before it is taken off.

In: a `Photo` and its instances. Out: `Matted`: facades and occluders.
Paper: sections 3.2 and 4.1, closed-form matting. Open `matte` first.
"""

from nostalgin_core.matte.matte import fronts, matte
from nostalgin_core.matte.redrawn import redrawn

__all__ = ["fronts", "matte", "redrawn"]
