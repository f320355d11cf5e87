"""The rim of a hole: soft edges in which the front is mixed with what hides it.

    texel = alpha front + (1 - alpha) occluder

Kept as they were photographed, they draw the outline of the person or the post that
was taken out. So the fill goes on under them: where less than half is the front's, the
fill stands alone; above, the photograph comes in with alpha, until it is the front's
alone. Texels marked as photographed are no part of this. What is mostly filled is
marked as inpainted, the rest stays a soft edge.
"""

import cv2
import numpy as np
from jaxtyping import Float, Float32

from nostalgin_core import evidence
from nostalgin_core.arrays import Alpha, EvidenceMap, Mask

HALO_PX = 8  # a soft edge this near the hole is mixed with what hides the front
SKY_PX = 3  # one this near to what is no facade is mixed with that, and left alone
MIXED = 0.5  # of the front: with less, the texel shows what stood before it


def near(mask: Mask, px: int) -> Mask:
    """Widen a mask by so many texels."""
    return cv2.dilate(mask.astype(np.uint8), np.ones((2 * px + 1,) * 2, np.uint8)) > 0


def soft(marks: EvidenceMap, hole: Mask) -> Mask:
    """Tell the soft edges round a hole: none of them is to be looked at."""
    return (marks == evidence.SOFT_EDGE) & near(hole, HALO_PX)


def rim(marks: EvidenceMap, hole: Mask) -> Mask:
    """Tell the soft edges round a hole that the fill goes on under."""
    return soft(marks, hole) & ~near(marks == evidence.NOTHING, SKY_PX)


def kept(alpha: Float[np.ndarray, "..."]) -> Float32[np.ndarray, "..."]:
    """Say what share of a rim's texel stays the photograph's, by its alpha."""
    return ((alpha - MIXED) / (evidence.SEEN - MIXED)).clip(0, 1).astype(np.float32)


def marked(marks: EvidenceMap, edge: Mask, alpha: Alpha) -> EvidenceMap:
    """Mark those texels of a rim as inpainted that mostly are."""
    changed = marks.copy()  # only the rim is looked at: alpha may have 10^8 texels
    filled = kept(alpha[edge]) < 0.5
    changed[edge] = np.where(filled, np.uint8(evidence.INPAINTED), marks[edge])
    return changed
