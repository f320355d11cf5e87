"""Encoded images of an atlas: bytes that go into a file as they are.

The colours become WebP or PNG with transparency; the colour under a transparent texel
is kept, for mipmaps read it. The evidence becomes a PNG of few colours, its tints.
"""

import io
from dataclasses import dataclass
from typing import Literal

import numpy as np
from PIL import Image

from nostalgin_core import evidence, rests
from nostalgin_core.model.atlas import Atlas

ImageFormat = Literal["webp", "png"]


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
    image.putpalette([part for _, tint in sorted(rests.TINTS.items()) for part in tint])
    file = io.BytesIO()
    image.save(file, "PNG", transparency=evidence.NOTHING, compress_level=9)
    return Picture(file.getvalue(), "image/png")


def legend() -> dict[str, dict[str, object]]:
    """Name the codes and their tints, to go with the file."""
    return {
        str(code): {"name": rests.NAMES[code], "tint": list(tint)}
        for code, tint in sorted(rests.TINTS.items())
    }
