"""Pictures of what each stage made, for people to look at."""

import cv2
import numpy as np
from jaxtyping import UInt8

from nostalgin_core import rests
from nostalgin_core.arrays import Alpha, Corners, EvidenceMap, Gray, Lines, Mask

Colour = UInt8[np.ndarray, "h w 3"]  # blue, green, red, as OpenCV writes them

# Distinct under the common kinds of colour blindness (Okabe and Ito, 2008).
FACADES = (
    (178, 114, 0),
    (115, 158, 0),
    (66, 228, 240),
    (233, 180, 86),
    (167, 121, 204),
    (0, 159, 230),
)
OCCLUDER = (0, 94, 213)
VERTICAL = (60, 60, 60)
NEITHER = (150, 150, 150)
VANISHING_TOLERANCE_DEG = 2.0  # a line further off belongs to no vanishing point


def facade_colour(index: int) -> tuple[int, int, int]:
    """Give each facade of a photo its own colour."""
    return FACADES[index % len(FACADES)]


def in_colour(image: Gray) -> Colour:
    """Turn a gray image to three channels."""
    return cv2.cvtColor(image, cv2.COLOR_GRAY2BGR)


def tinted(picture: Colour, mask: Mask, colour: tuple[int, int, int]) -> Colour:
    """Lay half of a colour over a mask."""
    out = picture.copy()
    out[mask] = (out[mask] // 2 + np.array(colour, np.uint8) // 2).astype(np.uint8)
    return out


def cut_out(image: Gray, alpha: Alpha) -> Colour:
    """Show an image where alpha is one, and white where it is zero."""
    shown = image * alpha + 255.0 * (1 - alpha)
    return in_colour(np.rint(shown).astype(np.uint8))


def outlined(
    picture: Colour, quad: Corners, colour: tuple[int, int, int], *, width_px: int
) -> Colour:
    """Draw a quadrangle, which may reach past the picture."""
    corners = np.rint(quad).astype(np.int32)
    return cv2.polylines(picture.copy(), [corners], True, colour, width_px)  # noqa: FBT003


def fits(lines: Lines, vanishing_point: np.ndarray) -> np.ndarray:
    """Tell which lines, seen from their middle, point at a vanishing point."""
    start, end = lines[:, :2], lines[:, 2:]
    middle = (start + end) / 2
    x, y, w = vanishing_point
    towards = np.array([x, y]) - w * middle
    along = end - start
    cross = along[:, 0] * towards[:, 1] - along[:, 1] * towards[:, 0]
    norm = np.linalg.norm(along, axis=1) * np.linalg.norm(towards, axis=1)
    limit = np.sin(np.radians(VANISHING_TOLERANCE_DEG))
    return np.abs(cross) <= limit * np.maximum(norm, 1e-12)


def stroked(picture: Colour, lines: Lines, colour: tuple[int, int, int]) -> Colour:
    """Draw lines in one colour."""
    out = picture.copy()
    for line in np.rint(lines).astype(int):
        cv2.line(out, line[:2].tolist(), line[2:].tolist(), colour, 1, cv2.LINE_AA)
    return out


def evidence_colours(codes: EvidenceMap) -> Colour:
    """Paint an evidence map by code, in the tints that a model's files bear."""
    palette = np.zeros((256, 3), np.uint8)
    for code, tint in rests.TINTS.items():
        palette[code] = tint[::-1]
    return palette[codes]
