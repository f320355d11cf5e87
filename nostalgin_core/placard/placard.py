"""The number board in a tax photo says which block and lot the photo records.

The board is a single line of white capitals, "996 -31 M": block, dash, lot, and the
borough's letter. A reader of print finds pieces of it ("996", "-31M") and sometimes
words of signs and watermarks beside it. The pieces on one line are joined and must then
spell the whole pattern: a wrong lot is worse than none, because it puts one house in
another's place.
"""

import re
from collections.abc import Callable, Iterable, Sequence
from typing import Final, NamedTuple

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Gray
from nostalgin_core.placard import spacing
from nostalgin_core.placard.misread import BOROUGHS
from nostalgin_core.records import Box, Instance, Photo, Placard, Rejection

LETTER_PX: Final = 40.0  # the height to which a board's letters are brought
LEAST_SCORE: Final = 0.6  # of the least sure piece

Corners = Sequence[Sequence[float]]
Ocr = Callable[[Gray], Iterable[tuple[Corners, str, float]]]
"""Maps an image to what is printed in it: four corners, text, score from 0 to 1."""


class Piece(NamedTuple):
    """One piece of print: its corners in photo pixels, its text, its score."""

    corners: Float[np.ndarray, "4 2"]
    text: str
    score: float


class Number(NamedTuple):
    """What a board says, and how much of the text it took."""

    block: str
    lot: str
    borough: str | None


def board(instances: Sequence[Instance]) -> Instance | None:
    """Choose the board that the network is surest of."""
    boards = [one for one in instances if one.category == "placard"]
    return max(boards, key=lambda one: one.score, default=None)


def read(photo: Photo, board: Instance | None, ocr: Ocr) -> Placard | Rejection:
    """Read a photo's board; without one, look for it in the lower half of the frame."""
    frame = photo.frame
    places = [] if board is None else list(_crops(board.box, frame))
    middle = frame.y0 + (frame.y1 - frame.y0) // 2
    lower = (Box(frame.x0, middle, frame.x1, frame.y1), 2.0)
    seen: list[str] = []
    for box, scale in [*places, lower]:
        pieces = pieces_in(photo.image, box, scale, ocr)
        for line in lines(pieces):
            found = _placard(line)
            # A range of house numbers on a sign is no board: there, ask for the letter.
            if found is not None and (found.borough or _on(board, found)):
                return found
        seen += [piece.text for piece in pieces]
    return Rejection(
        photo.key,
        "placard",
        "no number read" if seen else "no placard",
        f"print found: {' | '.join(seen[:8]) or 'none'}; write block and lot into the "
        "manifest by hand",
    )


def parse(texts: Sequence[str]) -> Number | None:
    """Read block, lot and borough from pieces of one line, from left to right.

    Spaces, the dash's place and look-alikes of digits don't matter. None where the
    pieces are not exactly a block, a lot and perhaps a letter.
    """
    joined = " ".join(_clean(text) for text in texts).strip()
    match = _WHOLE.fullmatch(joined) or _SPLIT.fullmatch(joined)
    if match is None:
        return None
    block, lot = match["block"].lstrip("0"), match["lot"].lstrip("0")
    if not block or not lot:
        return None
    return Number(block, lot, match["borough"])


_TAIL: Final = rf"(?P<lot>\d{{1,4}}) ?(?P<borough>[{BOROUGHS}])?"
_WHOLE: Final = re.compile(rf"(?P<block>\d{{2,5}}) ?[A-Z]? ?(?:- ?)+{_TAIL}")
_SPLIT: Final = re.compile(rf"(?P<block>\d{{2,5}}) {_TAIL}")  # the dash went unseen
_DASHES: Final = re.compile(r"[-_~\u2010-\u2015\u2212\uff0d\u4e00=]+")
_RUN_TOGETHER: Final = re.compile(rf"\d{{4,}}[{BOROUGHS}]?")
_LIKE_DIGITS: Final = str.maketrans("OQDIL|!", "0001111")


def _clean(text: str) -> str:
    """Write one piece in capitals, digits and dashes; drop other marks."""
    text = _DASHES.sub("-", text.upper())
    words = re.sub(r"[^A-Z0-9|!-]+", " ", text).split()
    return " ".join(_digits(word) for word in words)


def _digits(word: str) -> str:
    """Read look-alikes as digits where they stand among digits."""
    if not re.search(r"\d", word):
        return word
    tail = word[-1] if word[-1] in BOROUGHS else ""
    return word[: len(word) - len(tail)].translate(_LIKE_DIGITS) + tail


def lines(pieces: Sequence[Piece]) -> list[list[Piece]]:
    """Group pieces that stand on one line, each line from left to right.

    Each line is given whole first, then its shorter runs, longest first: signs beside
    the board stand on its line, too.
    """
    runs = [
        line[i : i + n]
        for line in whole_lines(pieces)
        for n in range(len(line), 0, -1)
        for i in range(len(line) - n + 1)
    ]
    return sorted(runs, key=len, reverse=True)


def whole_lines(pieces: Sequence[Piece]) -> list[list[Piece]]:
    """Group pieces that stand on one line, each line from left to right."""
    rest = sorted(pieces, key=lambda p: -_height(p))
    grouped: list[list[Piece]] = []
    while rest:
        first = rest[0]
        line = [p for p in rest if _on_line(first, p)]
        rest = [p for p in rest if not _on_line(first, p)]
        grouped.append(sorted(line, key=lambda p: float(p.corners[:, 0].mean())))
    return grouped


def _height(piece: Piece) -> float:
    left, right = (
        piece.corners[3] - piece.corners[0],
        piece.corners[2] - piece.corners[1],
    )
    return float(np.linalg.norm(left) + np.linalg.norm(right)) / 2


def _on_line(first: Piece, other: Piece) -> bool:
    """Tell whether another piece continues a line: its height, its size, its slant."""
    along = first.corners[1] - first.corners[0]
    along = along / max(1e-6, float(np.linalg.norm(along)))
    off = other.corners.mean(axis=0) - first.corners.mean(axis=0)
    across = abs(float(along[0] * off[1] - along[1] * off[0]))
    tall, short = _height(first), _height(other)
    return across < 0.6 * tall and short > 0.4 * tall


def _placard(line: Sequence[Piece]) -> Placard | None:
    number = parse([piece.text for piece in line])
    score = min(piece.score for piece in line)
    if number is None or score < LEAST_SCORE:
        return None
    points = np.concatenate([piece.corners for piece in line]).astype(np.float32)
    corners = cv2.boxPoints(cv2.minAreaRect(points))
    return Placard(
        text=" ".join(piece.text for piece in line),
        block=number.block,
        lot=number.lot,
        borough=number.borough,
        score=float(score),
        box=tuple((float(x), float(y)) for x, y in _clockwise(corners)),
    )


def _on(board: Instance | None, found: Placard) -> bool:
    """Tell whether a number stands where the network saw a board, or nearly there."""
    if board is None:
        return False
    x0, y0, x1, y1 = board.box
    x, y = np.array(found.box).mean(axis=0)
    w, h = x1 - x0, y1 - y0
    return bool(x0 - w / 2 <= x <= x1 + w / 2 and y0 - h / 2 <= y <= y1 + h / 2)


def _clockwise(corners: np.ndarray) -> np.ndarray:
    """Order four corners from the top left on, clockwise as seen."""
    off = corners - corners.mean(axis=0)
    turned = corners[np.argsort(np.arctan2(off[:, 1], off[:, 0]))]
    start = int(np.argmin(turned.sum(axis=1)))
    return np.roll(turned, -start, axis=0)


def _crops(board: Box, frame: Box) -> Iterable[tuple[Box, float]]:
    """Cut the board out with two margins: letters are about half as high as it."""
    w, h = board.x1 - board.x0, board.y1 - board.y0
    scale = min(6.0, max(1.0, 2 * LETTER_PX / h))
    for wide, high in ((0.15, 0.3), (0.4, 1.0)):
        yield (
            Box(
                max(frame.x0, int(board.x0 - wide * w)),
                max(frame.y0, int(board.y0 - high * h)),
                min(frame.x1, int(board.x1 + wide * w) + 1),
                min(frame.y1, int(board.y1 + high * h) + 1),
            ),
            scale,
        )


def pieces_in(image: Gray, box: Box, scale: float, ocr: Ocr) -> list[Piece]:
    """Read a part of the photo, enlarged; corners come back in photo pixels."""
    part = image[box.y0 : box.y1, box.x0 : box.x1]
    if min(part.shape) == 0:
        return []
    large = cv2.resize(part, None, fx=scale, fy=scale, interpolation=cv2.INTER_CUBIC)
    # Pixel centres lie at whole numbers: the first pixel's edge is at -0.5.
    pieces = []
    for found, text, score in ocr(large):
        corners = np.array(found, float)
        fused = _RUN_TOGETHER.fullmatch(text)
        said = spacing.parted(large, corners, text) if fused else text
        pieces.append(Piece((corners + 0.5) / scale - 0.5 + box[:2], said, score))
    return pieces
