"""A board is looked at several times: what one rendering hides, another shows.

A reader of print finds a box for each word before it reads it, and what it finds hangs
on the margin round the board and on which of ink and ground is the brighter. So the
board is cut out with three margins and in two sizes, as it is, inverted, and with its
contrast evened out (CLAHE; Zuiderveld, 1994); each rendering is read by itself. Where
the network saw no board, or no figure is read on it, print is sought in the lower half
of the frame, and what looks most like a board's line is looked at in the same way.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final, Literal, NamedTuple

import cv2
import numpy as np

from nostalgin_core.arrays import Gray
from nostalgin_core.placard import misread
from nostalgin_core.placard.joined import Look, number
from nostalgin_core.placard.placard import (
    LETTER_PX,
    Ocr,
    Piece,
    parse,
    pieces_in,
    whole_lines,
)
from nostalgin_core.records import Box, Instance, Photo

Found = Literal["segmented", "searched", ""]
Tone = Literal["plain", "inverted", "even"]


class Rendering(NamedTuple):
    """How a board is shown to the reader."""

    wide: float  # margin, in widths of the board
    high: float  # in heights
    tone: Tone
    larger: float = 1.0  # than letters of `LETTER_PX`


RENDERINGS: Final = (
    Rendering(0.4, 1.0, "plain"),
    Rendering(0.4, 1.0, "inverted"),
    Rendering(0.4, 1.0, "even"),
    Rendering(0.4, 1.0, "plain", larger=1.5),
    Rendering(0.15, 0.3, "plain"),
    Rendering(0.03, 0.0, "plain"),
)
EVEN: Final = 2.0  # CLAHE's limit of contrast
TILES: Final = (4, 4)
LARGEST: Final = 6.0  # times a small board is enlarged
SEARCHED_AT: Final = 2.0  # times the lower half is
SLENDER: Final = (1.25, 1.8)  # a board's width and height, over those of its print


@dataclass(frozen=True)
class Sight:
    """What is seen of a photo's board: where it is, how it was found, what is read."""

    found: Found
    box: Box | None
    looks: tuple[Look, ...]


def looked(photo: Photo, board: Instance | None, ocr: Ocr) -> Sight:
    """Look at a photo's board; seek it where the network saw none that can be read."""
    if board is not None:
        looks = looks_at(photo, board.box, ocr)
        if any(telling(look) for look in looks):
            return Sight("segmented", board.box, looks)
    box = sought(photo, ocr)
    if box is not None:
        return Sight("searched", box, looks_at(photo, box, ocr))
    if board is not None:
        return Sight("segmented", board.box, ())
    return Sight("", None, ())


def looks_at(photo: Photo, board: Box, ocr: Ocr) -> tuple[Look, ...]:
    """Read a board in each of its renderings."""
    found = []
    for one in RENDERINGS:
        scale = 2 * LETTER_PX * one.larger / max(1, board.y1 - board.y0)
        part = widened(board, photo.frame, wide=one.wide, high=one.high)
        shown = partial(toned, how=one)
        pieces = pieces_in(
            photo.image, part, min(LARGEST, scale), lambda p, shown=shown: ocr(shown(p))
        )
        found.append(look(pieces))
    return tuple(found)


def look(pieces: Sequence[Piece]) -> Look:
    """Take the texts of pieces, line by line."""
    return Look(tuple(tuple(one.text for one in line) for line in whole_lines(pieces)))


def telling(one: Look) -> bool:
    """Tell whether a look shows a line that may be of a board."""
    return any(number(misread.cleaned(" ".join(line))) for line in one.lines)


def sought(photo: Photo, ocr: Ocr) -> Box | None:
    """Find the line in the lower half of the frame that spells a board, with a letter.

    A range of house numbers on a sign has none.
    """
    frame = photo.frame
    middle = frame.y0 + (frame.y1 - frame.y0) // 2
    lower = Box(frame.x0, middle, frame.x1, frame.y1)
    pieces = pieces_in(photo.image, lower, SEARCHED_AT, ocr)
    for line in whole_lines(pieces):
        runs = [line[i : i + n] for n in (3, 2, 1) for i in range(len(line) - n + 1)]
        for run in runs:
            read = parse([one.text for one in run])
            if read is not None and read.borough:
                return round_print(run, frame)
    return None


def round_print(run: Sequence[Piece], frame: Box) -> Box:
    """Give the board that print stands on."""
    points = np.concatenate([piece.corners for piece in run])
    low, high = points.min(axis=0), points.max(axis=0)
    middle, half = (low + high) / 2, (high - low) / 2 * np.array(SLENDER)
    (x0, y0), (x1, y1) = middle - half, middle + half
    return widened(Box(int(x0), int(y0), int(x1) + 1, int(y1) + 1), frame)


def widened(board: Box, frame: Box, *, wide: float = 0, high: float = 0) -> Box:
    """Add a margin to a board, within the frame."""
    w, h = board.x1 - board.x0, board.y1 - board.y0
    return Box(
        max(frame.x0, int(board.x0 - wide * w)),
        max(frame.y0, int(board.y0 - high * h)),
        min(frame.x1, int(board.x1 + wide * w) + 1),
        min(frame.y1, int(board.y1 + high * h) + 1),
    )


def toned(part: Gray, how: Rendering) -> Gray:
    """Show a part of a photo in a tone."""
    if how.tone == "inverted":
        return 255 - part
    if how.tone == "even":
        return cv2.createCLAHE(EVEN, TILES).apply(part)
    return part


def crop(photo: Photo, box: Box | None) -> Gray:
    """Cut out what people are to look at: the board, or the lower half without one."""
    frame = photo.frame
    middle = frame.y0 + (frame.y1 - frame.y0) // 2
    seen = Box(frame.x0, middle, frame.x1, frame.y1)
    if box is not None:
        seen = widened(box, frame, wide=0.4, high=1.2)
    return photo.image[seen.y0 : seen.y1, seen.x0 : seen.x1]
