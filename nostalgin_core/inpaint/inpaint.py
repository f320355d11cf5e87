"""Fill what people, cars and posts hid, and what lies beyond the photograph's frame.

The texels that the evidence map calls inpainted or beyond the frame are filled, and
the fill goes on under the soft edges round them (`rim`). Nothing that is marked as
photographed is changed, bit for bit. What is not the facade at all, as the sky beside
a gable, is hidden from the network, so that it can't bleed in.

The hole is first filled by a guess, made of what repeats on the front
(`repetition.guess`); the network then looks at it in slices (`slices`) and mends it.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import cv2
import numpy as np
from jaxtyping import Bool, Float32, Shaped, UInt8

from nostalgin_core import evidence
from nostalgin_core.arrays import EvidenceMap, Gray, Mask
from nostalgin_core.inpaint import floors
from nostalgin_core.inpaint.repetition import guess
from nostalgin_core.inpaint.rim import kept, marked, rim, soft
from nostalgin_core.inpaint.slices import CHUNK_PX, CONTEXT_PX, Slice, share, slices
from nostalgin_core.records import Box, Elevation

Network = Callable[..., tuple[Float32[np.ndarray, "1 1 h w"], ...]]
"""Given image, hole and guess (images from -1 to 1), answer with the filled image."""

Smaller = UInt8[np.ndarray, "h2 w2"]
SmallerMask = Bool[np.ndarray, "h2 w2"]

MULTIPLE = 8  # the network's sizes
GUESSED_PX = 2_000_000  # larger images are guessed at this size, to bound the memory
LOOKED_PX = 100_000  # and the network looks at them at this one, as it learnt


def holes(marks: EvidenceMap) -> Mask:
    """Tell which texels are to be filled."""
    return (marks == evidence.INPAINTED) | (marks == evidence.BEYOND_FRAME)


def unknown(marks: EvidenceMap) -> Mask:
    """Tell which texels must not be looked at.

    Beside the hole and what is no facade, these are the soft edges round the hole.
    """
    hole = holes(marks)
    return hole | soft(marks, hole) | (marks == evidence.NOTHING)


def _smaller(image: Gray, hidden: Mask, largest: int) -> tuple[Smaller, SmallerMask]:
    """Shrink an image to at most so many texels, from what is not hidden alone."""
    h, w = image.shape
    shrink = (largest / (h * w)) ** 0.5
    if shrink >= 1:
        return image, hidden
    size = (max(1, round(w * shrink)), max(1, round(h * shrink)))
    seen = (~hidden).astype(np.uint8) * 255
    part = cv2.resize(seen, size, interpolation=cv2.INTER_AREA)
    sums = cv2.resize(image & seen, size, interpolation=cv2.INTER_AREA)
    mean = sums.astype(np.float32) * 255 / np.maximum(part, 1)
    return _gray(mean), part < 128


def _gray(values: Shaped[np.ndarray, "..."]) -> UInt8[np.ndarray, "..."]:
    """Round to gray levels."""
    return np.clip(np.round(values), 0, 255).astype(np.uint8)


def _guess(image: Gray, hidden: Mask) -> Gray:
    """Guess what is hidden; a large image is guessed at a smaller size."""
    small, unseen = _smaller(image, hidden, GUESSED_PX)
    made = _gray(guess(small.astype(np.float32), unseen))
    if made.shape == image.shape:
        return made
    wide = cv2.resize(made, image.shape[::-1], interpolation=cv2.INTER_LINEAR)
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
    return _gray((filled[0, 0, :h, :w] + 1) * 127.5)


def _stitched(
    image: Gray, hidden: Mask, guessed: Gray, pieces: list[Slice], network: Network
) -> Float32[np.ndarray, "h w"]:
    """Ask slice by slice what is to be added to the guess; overlaps fade over."""
    added = np.zeros(image.shape, np.float32)
    for piece in pieces:
        view, cell = piece.view, piece.cell
        made = _look(image, hidden, guessed, view, network)
        inner = np.s_[
            cell.y0 - view.y0 : cell.y1 - view.y0, cell.x0 - view.x0 : cell.x1 - view.x0
        ]
        outer = np.s_[cell.y0 : cell.y1, cell.x0 : cell.x1]
        added[outer] += (made[inner].astype(np.float32) - guessed[outer]) * share(piece)
    return added


def whole(elevation: Elevation, network: Network) -> Elevation:
    """Fill an elevation in one look at all of it: memory grows with its area."""

    def everything(hole: Mask) -> list[Slice]:
        h, w = hole.shape
        box = Box(0, 0, w, h)
        return [Slice(box, box, (False, False, False, False))]

    return _filled(elevation, network, everything)


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
    cut = partial(slices, context=context, chunk=chunk)
    return _filled(elevation, network, cut)


def _filled(
    elevation: Elevation, network: Network, cut: Callable[[Mask], list[Slice]]
) -> Elevation:
    """Fill the hole of an elevation, if it has one.

    The network learnt on fronts of a few hundred texels, so it is shown a larger one
    at that size, and what it adds to the guess is enlarged.
    """
    image, marks = elevation.image, elevation.evidence
    hole = holes(marks)
    if not hole.any():
        return elevation
    edge = rim(marks, hole)
    wanted, hidden = hole | edge, unknown(marks)
    guessed = _guess(image, hidden)
    small, unseen = _smaller(image, hidden, LOOKED_PX)
    if small.shape == image.shape:
        added = _stitched(image, hidden, guessed, cut(wanted), network)
    else:
        size = small.shape[::-1]
        start = cv2.resize(guessed, size, interpolation=cv2.INTER_AREA)
        part = cv2.resize(
            wanted.astype(np.uint8), size, interpolation=cv2.INTER_NEAREST
        )
        added = _stitched(small, unseen, start, cut(unseen & (part > 0)), network)
        added = cv2.resize(added, image.shape[::-1], interpolation=cv2.INTER_LINEAR)
    out = image.copy()
    out[wanted] = _gray(guessed[wanted] + added[wanted])
    share = kept(elevation.alpha[edge])
    out[edge] = _gray(share * image[edge] + (1 - share) * out[edge])
    return replace(elevation, image=out, evidence=marked(marks, edge, elevation.alpha))


def inpaint(elevation: Elevation, network: Network) -> Elevation:
    """Fill an elevation as the pipeline does: slice by slice, then floors deep inside.

    The evidence map already says what is filled; soft edges round it that are mostly
    filled as well are marked so, too, and repeated floors as copied.
    """
    return floors.repeated(low_memory(elevation, network))
