"""Each facade is seen straight on: lines, vanishing points, quad, focal length, aspect.

In: a `Photo` and what was matted; a known watermark is taken out of it first. Out: an
`Elevation` or a `Rejection` a facade, and the `Standpoint` of the camera that each
elevation tells.
Paper: section 3.3. Open `rectify` first, then `orient`.
"""

from nostalgin_core.rectify.cleared import unmarked
from nostalgin_core.rectify.drawn import drawn
from nostalgin_core.rectify.legible import sharpness, stretched
from nostalgin_core.rectify.rectify import rectify
from nostalgin_core.rectify.standpoint import standpoint
from nostalgin_core.rectify.watermark import Watermark

__all__ = [
    "Watermark",
    "drawn",
    "rectify",
    "sharpness",
    "standpoint",
    "stretched",
    "unmarked",
]
