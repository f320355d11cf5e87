"""Encoded images of an atlas: bytes that go into a file as they are.

The colours become WebP or PNG with transparency; the colour under a transparent texel
is kept, for mipmaps read it. The evidence becomes a PNG of few colours. They are chosen
so that multiplying a photograph by them tints it: what a camera saw is white and stays
as it is.
"""

import io
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from PIL import Image

from nostalgin_core import evidence
from nostalgin_core.atlas import Atlas

ImageFormat = Literal["webp", "png"]

TINTS: Final = {
    evidence.NOTHING: (0, 0, 0),
    evidence.PHOTOGRAPHED: (255, 255, 255),
    evidence.SOFT_EDGE: (255, 244, 190),
    evidence.INPAINTED: (255, 150, 70),
    evidence.BEYOND_FRAME: (235, 90, 120),
    evidence.COPIED: (90, 170, 255),
    evidence.ASSUMED: (170, 140, 230),
}


@dataclass(frozen=True, slots=True)
class Picture:
    """An encoded image."""

    data: bytes
    mime: str


def colours(
    atlas: Atlas, *, image_format: ImageFormat = "webp", quality: int = 85
) -> Picture:
    """Encode the colours with their opacity.

    At quality 85 a texel of a WebP is off by two or three gray levels, less than the
    film's grain. PNG is lossless and read by every program, at about ten times the
    size.
    """
    image = Image.fromarray(np.dstack([atlas.image] * 3 + [atlas.opacity]))
    file = io.BytesIO()
    if image_format == "png":
        gray = Image.fromarray(np.dstack([atlas.image, atlas.opacity]), "LA")
        gray.save(file, "PNG", optimize=False, compress_level=9)
        return Picture(file.getvalue(), "image/png")
    image.save(file, "WEBP", quality=quality, method=4, exact=True)
    return Picture(file.getvalue(), "image/webp")


def evidence_key(atlas: Atlas) -> Picture:
    """Encode the evidence as a PNG whose palette index is the code."""
    image = Image.fromarray(atlas.evidence, "P")
    image.putpalette([part for code in sorted(TINTS) for part in TINTS[code]])
    file = io.BytesIO()
    image.save(file, "PNG", transparency=evidence.NOTHING, compress_level=9)
    return Picture(file.getvalue(), "image/png")


def legend() -> dict[str, dict[str, object]]:
    """Name the codes and their tints, to go with the file."""
    return {
        str(code): {"name": evidence.NAMES[code], "tint": list(TINTS[code])}
        for code in sorted(TINTS)
    }
