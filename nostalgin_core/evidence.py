"""What each texel of an elevation rests on: the promise made to historians.

The map flows from `rectify` to the viewer. `PHOTOGRAPHED` texels are never changed by
any later stage, bit for bit.
"""

from typing import Final

NOTHING: Final = 0
PHOTOGRAPHED: Final = 1
SOFT_EDGE: Final = 2  # photographed, mixed with what is before or behind, or its fill
INPAINTED: Final = 3  # hidden in the photo, filled by the inpainter
BEYOND_FRAME: Final = 4  # outside the photo's exposed frame, filled
COPIED: Final = 5  # copied from elsewhere on the building
ASSUMED: Final = 6  # no photograph: a plain volume

SEEN: Final = 0.95  # alpha above which a texel is the front's alone, no soft edge

NAMES: Final = {
    NOTHING: "nothing",
    PHOTOGRAPHED: "photographed",
    SOFT_EDGE: "photographed at a soft edge",
    INPAINTED: "inpainted",
    BEYOND_FRAME: "filled beyond the photo's frame",
    COPIED: "copied from elsewhere on the building",
    ASSUMED: "assumed",
}

# Multiplying a photograph by these tints it: what a camera saw stays as it is.
TINTS: Final = {  # red, green, blue
    NOTHING: (0, 0, 0),
    PHOTOGRAPHED: (255, 255, 255),
    SOFT_EDGE: (255, 244, 190),
    INPAINTED: (255, 150, 70),
    BEYOND_FRAME: (235, 90, 120),
    COPIED: (90, 170, 255),
    ASSUMED: (170, 140, 230),
}
