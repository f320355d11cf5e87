"""Where the low-memory inpainter looks: slices round the parts of a hole.

Each connected part of the hole gets a box with some context round it; boxes that
overlap become one (paper, section 4.3 "Inpainter Scalability"). A box larger than a
chunk is cut into cells that overlap a little, so that neighbours can be faded into one
another; each cell again gets its context. What is looked at at once is so never larger
than a chunk, whatever the image's size.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float32
from scipy import ndimage

from nostalgin_core.arrays import Mask
from nostalgin_core.records import Box

Weights = Float32[np.ndarray, "h w"]

CONTEXT_PX = 100  # the paper's context radius
CHUNK_PX = (400, 600)  # the paper's largest chunk, taken as height and width
FADE_PX = 24  # how far two cells of one box overlap


class Slice(NamedTuple):
    """One view of the network: it sees `view` and answers for `cell` inside it."""

    view: Box
    cell: Box
    fades: tuple[bool, bool, bool, bool]  # left, top, right, bottom: shared there


def grown(box: Box, by: int, shape: tuple[int, int]) -> Box:
    """Widen a box on all sides, inside the image."""
    h, w = shape
    return Box(
        max(0, box.x0 - by),
        max(0, box.y0 - by),
        min(w, box.x1 + by),
        min(h, box.y1 + by),
    )


def _overlap(a: Box, b: Box) -> bool:
    """Tell whether two boxes share a texel."""
    return a.x0 < b.x1 and b.x0 < a.x1 and a.y0 < b.y1 and b.y0 < a.y1


def merged(boxes: list[Box]) -> list[Box]:
    """Join boxes that overlap until none does."""
    apart: list[Box] = []
    for box in boxes:
        joined = box
        while touching := [other for other in apart if _overlap(joined, other)]:
            apart = [other for other in apart if other not in touching]
            x0, y0, x1, y1 = zip(joined, *touching, strict=True)
            joined = Box(min(x0), min(y0), max(x1), max(y1))
        apart.append(joined)
    return sorted(apart, key=lambda box: (box.y0, box.x0))


def bounds(hole: Mask, within: Box) -> Box | None:
    """Find the smallest box of what is hidden inside another box."""
    part = hole[within.y0 : within.y1, within.x0 : within.x1]
    rows, columns = (np.flatnonzero(part.any(axis=a)) for a in (1, 0))
    if not len(rows):
        return None
    return Box(
        within.x0 + int(columns[0]),
        within.y0 + int(rows[0]),
        within.x0 + int(columns[-1]) + 1,
        within.y0 + int(rows[-1]) + 1,
    )


def parts(hole: Mask, *, context: int = CONTEXT_PX) -> list[Box]:
    """Box every part of the hole with its context, overlapping boxes joined."""
    labels = np.empty(hole.shape, np.int32)
    ndimage.label(hole, output=labels)
    found = ndimage.find_objects(labels)
    boxes = [Box(x.start, y.start, x.stop, y.stop) for y, x in found]
    return merged([grown(box, context, hole.shape) for box in boxes])


def _cuts(start: int, stop: int, longest: int) -> list[tuple[int, int]]:
    """Cut a stretch into pieces of equal length that overlap by the fade."""
    length = stop - start
    if length <= longest:
        return [(start, stop)]
    count = -(-(length - FADE_PX) // (longest - FADE_PX))
    step = (length - FADE_PX) / count
    begins = [start + round(i * step) for i in range(count)]
    ends = [begin + FADE_PX for begin in begins[1:]]
    return list(zip(begins, [*ends, stop], strict=True))


def slices(
    hole: Mask, *, context: int = CONTEXT_PX, chunk: tuple[int, int] = CHUNK_PX
) -> list[Slice]:
    """Cover the hole by views of at most a chunk, from the top left on.

    Raises:
        ValueError: if a chunk leaves no room between its contexts.
    """
    room = [n - 2 * context for n in chunk]
    if min(room) <= 2 * FADE_PX:
        raise ValueError(f"chunks of {chunk} px leave no room for context {context}")
    made = []
    for box in parts(hole, context=context):
        inner = bounds(hole, box)
        if inner is None:
            continue
        rows = _cuts(inner.y0, inner.y1, room[0])
        columns = _cuts(inner.x0, inner.x1, room[1])
        for y0, y1 in rows:
            for x0, x1 in columns:
                cell = Box(x0, y0, x1, y1)
                if bounds(hole, cell) is None:
                    continue
                low = x0 > inner.x0, y0 > inner.y0
                high = x1 < inner.x1, y1 < inner.y1
                view = grown(cell, context, hole.shape)
                made.append(Slice(view, cell, (*low, *high)))
    return made


def share(piece: Slice) -> Weights:
    """Weigh a cell's answer: where cells overlap, their shares add up to one."""
    left, top, right, bottom = piece.fades
    rise = np.arange(1, FADE_PX + 1, dtype=np.float32) / (FADE_PX + 1)
    h, w = piece.cell.y1 - piece.cell.y0, piece.cell.x1 - piece.cell.x0
    down, across = np.ones(h, np.float32), np.ones(w, np.float32)
    for side, first, last in ((down, top, bottom), (across, left, right)):
        if first:
            side[:FADE_PX] *= rise
        if last:
            side[-FADE_PX:] *= rise[::-1]
    return np.outer(down, across)
