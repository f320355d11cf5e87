"""PatchMatch, for comparison: the library `pypatchmatch`, where it is installed.

Barnes et al., "PatchMatch: A Randomized Correspondence Algorithm for Structural Image
Editing". The paper ran it with patches of 50 to 73 px and a search of 100 px; the
library has one size of patch, and searches the whole picture.
"""

from importlib import import_module
from importlib.util import find_spec

import numpy as np

from nostalgin_core.arrays import Gray, Mask
from pipelines.evaluate import Unmeasurable

RADIUS_PX = 25  # patches of 51 px: the least of the paper's sizes
SMALL_RADIUS_PX = 3  # patches of 7 px: what the library's own examples use
PACKAGE = "patchmatch"


def available() -> bool:
    """Tell whether the library is there."""
    return find_spec(PACKAGE) is not None


def patchmatch(image: Gray, hole: Mask, *, radius: int = RADIUS_PX) -> Gray:
    """Fill by patches copied from elsewhere in the picture, always alike.

    Raises:
        Unmeasurable: if the library is not installed.
    """
    if not available():
        raise Unmeasurable(
            "PatchMatch needs a library: pip install nostalgin[compare], or leave it "
            "out of --methods"
        )
    library = import_module(PACKAGE)
    library.set_random_seed(0)
    colour = np.repeat(image[..., None], 3, axis=2)
    return library.inpaint(colour, hole, patch_size=radius)[..., 0]
