"""Fill what people, cars and posts hid, and what lies beyond the photograph's frame.

Exactly the texels that the evidence map calls inpainted or beyond the frame are
filled. Nothing that a camera saw is changed, bit for bit. What is not the facade at
all, as the sky beside a gable, is hidden from the network, so that it can't bleed in.

The hole is first filled by a guess, made of what repeats on the front
(`repetition.guess`); the network then looks at it in slices (`slices`) and mends it.
"""

from collections.abc import Callable
from dataclasses import replace

import cv2
import numpy as np
from jaxtyping import Float32, UInt8

from nostalgin_core import evidence
from nostalgin_core.arrays import EvidenceMap, Gray, Mask
from nostalgin_core.records import Box, Elevation
from nostalgin_core.repetition import guess
from nostalgin_core.slices import CHUNK_PX, CONTEXT_PX, Slice, share, slices

Network = Callable[..., tuple[Float32[np.ndarray, "1 1 h w"], ...]]
"""Given image, hole and guess (images from -1 to 1), answer with the filled image."""

MULTIPLE = 8  # the network's sizes
GUESS_PX = 2_000_000  # larger images are guessed at this size, to bound the memory
HALO_PX = 3  # a soft edge this near the hole is mixed with what hides the front


def holes(marks: EvidenceMap) -> Mask:
    """Tell which texels are to be filled."""
    return (marks == evidence.INPAINTED) | (marks == evidence.BEYOND_FRAME)


def unknown(marks: EvidenceMap) -> Mask:
    """Tell which texels must not be looked at.

    Beside the hole and what is no facade, these are the soft edges round the hole.
    """
    hole = holes(marks)
    near = cv2.dilate(hole.astype(np.uint8), np.ones((2 * HALO_PX + 1,) * 2, np.uint8))
    soft = (marks == evidence.SOFT_EDGE) & (near > 0)
    return hole | soft | (marks == evidence.NOTHING)


def _guess(image: Gray, hidden: Mask) -> Gray:
    """Guess what is hidden; a large image is guessed at a smaller size."""
    h, w = image.shape
    shrink = (GUESS_PX / (h * w)) ** 0.5
    if shrink >= 1:
        made = guess(image.astype(np.float32), hidden)
        return np.clip(np.round(made), 0, 255).astype(np.uint8)
    size = (max(1, round(w * shrink)), max(1, round(h * shrink)))
    part = cv2.resize(
        (~hidden).astype(np.uint8) * 255, size, interpolation=cv2.INTER_AREA
    )
    seen = cv2.resize(
        np.where(hidden, 0, image).astype(np.uint8), size, interpolation=cv2.INTER_AREA
    )
    small = seen.astype(np.float32) * 255 / np.maximum(part, 1)
    made = np.clip(np.round(guess(small, part < 128)), 0, 255).astype(np.uint8)
    wide = cv2.resize(made, (w, h), interpolation=cv2.INTER_LINEAR)
    return np.where(hidden, wide, image)


def _scaled(part: Gray, *, down: int, right: int) -> Float32[np.ndarray, "1 1 h2 w2"]:
    """Give a part of an image as the network wants it, enlarged by its last texels."""
    padded = np.pad(part, ((0, down), (0, right)), mode="edge")
    return (padded.astype(np.float32) / 127.5 - 1)[None, None]


def _look(
    image: Gray, hidden: Mask, guessed: Gray, view: Box, network: Network
) -> UInt8[np.ndarray, "h2 w2"]:
    """Let the network fill one view."""
    window = np.s_[view.y0 : view.y1, view.x0 : view.x1]
    h, w = view.y1 - view.y0, view.x1 - view.x0
    down, right = -h % MULTIPLE, -w % MULTIPLE
    hole = np.pad(hidden[window], ((0, down), (0, right)), constant_values=True)
    filled = network(
        _scaled(image[window], down=down, right=right),
        hole.astype(np.float32)[None, None],
        _scaled(guessed[window], down=down, right=right),
    )[0]
    gray = (filled[0, 0, :h, :w] + 1) * 127.5
    return np.clip(np.round(gray), 0, 255).astype(np.uint8)


def _stitched(
    image: Gray,
    hole: Mask,
    hidden: Mask,
    pieces: list[Slice],
    network: Network,
) -> Gray:
    """Fill slice by slice; where two overlap, one fades into the other."""
    guessed = _guess(image, hidden)
    total = np.zeros(image.shape, np.float32)
    for piece in pieces:
        view, cell = piece.view, piece.cell
        made = _look(image, hidden, guessed, view, network)
        inner = np.s_[
            cell.y0 - view.y0 : cell.y1 - view.y0, cell.x0 - view.x0 : cell.x1 - view.x0
        ]
        total[cell.y0 : cell.y1, cell.x0 : cell.x1] += made[inner] * share(piece)
    np.copyto(total, image, where=~hole)
    return np.round(total).astype(np.uint8)


def whole(elevation: Elevation, network: Network) -> Elevation:
    """Fill an elevation in one look at all of it: memory grows with its area."""
    h, w = elevation.image.shape
    everything = Box(0, 0, w, h)
    return _filled(elevation, network, [Slice(everything, everything, (False,) * 4)])


def low_memory(
    elevation: Elevation,
    network: Network,
    *,
    context: int = CONTEXT_PX,
    chunk: tuple[int, int] = CHUNK_PX,
) -> Elevation:
    """Fill an elevation slice by slice: memory for the network is bounded.

    Paper, section 4.3: context of 100 px, chunks of at most 400 x 600 px.
    """
    pieces = slices(holes(elevation.evidence), context=context, chunk=chunk)
    return _filled(elevation, network, pieces)


def _filled(elevation: Elevation, network: Network, pieces: list[Slice]) -> Elevation:
    """Fill the hole of an elevation, if it has one."""
    hole = holes(elevation.evidence)
    if not hole.any():
        return elevation
    hidden = unknown(elevation.evidence)
    image = _stitched(elevation.image, hole, hidden, pieces, network)
    return replace(elevation, image=image)


def inpaint(elevation: Elevation, network: Network) -> Elevation:
    """Fill an elevation as the pipeline does: slice by slice.

    The evidence map already says what is filled, and stays as it is.
    """
    return low_memory(elevation, network)
