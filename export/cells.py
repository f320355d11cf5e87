"""Outlines become shares of cells: what the semantic branch should answer.

A cell is 4 x 4 pixels, and an outline cuts most that it meets in two; a share says so.
Five planes a photo:

    0 ground   1 front   2 what hides it    shares of the cell, less its far rows
    3 an end of a front                     1 where an outline passes, 0 elsewhere
    4 seen                                  1 where ends count: nothing far or before it

An end behind a car counts neither way, since painted photographs don't tell it.
"""

from collections.abc import Sequence
from typing import Final

import cv2
import numpy as np
from jaxtyping import Float32, UInt8

from export.segmentation_data import SHIFT_BITS, Sample, fill
from nostalgin_core.arrays import Mask, Points

CELL_PX: Final = 4
END_PX: Final = 3  # outlines are good to about this
NEAR_PX: Final = 4  # of what hides a front, where its outline may be drawn as an end

Cells = Float32[np.ndarray, "5 rows columns"]


def cells(sample: Sample) -> Cells:
    """Rasterise a sample, whose sides are multiples of 4."""
    shape = sample.image.shape
    fronts = [t for t in sample.things if t.category == "facade"]
    hiding = _union([fill(t.rings, shape) for t in sample.things if t.layer], shape)
    built = _union([fill(t.rings, shape) for t in fronts if t.scored], shape)
    far = _union([fill(t.rings, shape) for t in fronts if not t.scored], shape)
    front = built & ~hiding
    far &= ~built & ~hiding
    ground = ~(built | hiding | far)
    ends = np.zeros(shape, np.uint8)
    for thing in fronts:
        if thing.scored:
            _draw(thing.rings, ends)
    kernel = np.ones((2 * NEAR_PX + 1,) * 2, np.uint8)
    unseen = far | (cv2.dilate(hiding.astype(np.uint8), kernel) > 0)
    planes = [_share(m) for m in (ground, front, hiding)]
    planes += [(_share(ends > 0) >= 0.5), 1 - (_share(unseen) > 0)]
    return np.stack(planes).astype(np.float32)


def _draw(rings: Sequence[Points], ends: UInt8[np.ndarray, "h w"]) -> None:
    """Draw rings as lines into a plane, in place."""
    fixed = [np.round(ring * 2**SHIFT_BITS).astype(np.int32) for ring in rings]
    cv2.polylines(
        ends, fixed, isClosed=True, color=1, thickness=END_PX, shift=SHIFT_BITS
    )


def _share(mask: Mask) -> Float32[np.ndarray, "rows columns"]:
    """Return the share of each cell that a mask covers."""
    rows, columns = (side // CELL_PX for side in mask.shape)
    parts = mask.reshape(rows, CELL_PX, columns, CELL_PX)
    return parts.mean((1, 3)).astype(np.float32)


def _union(masks: list[Mask], shape: tuple[int, int]) -> Mask:
    return np.any(masks, axis=0) if masks else np.zeros(shape, bool)
