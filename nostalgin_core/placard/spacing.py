"""A word that a reader ran together is parted again at its widest gap.

A reader of print tells letters well and spaces badly: the board "997 -10 M" comes back
as "99710M". The picture still shows where the gap is: the columns between two letters
that hold no ink. A dash is lower than letters, and counts as part of the gap.
"""

from itertools import pairwise

import cv2
import numpy as np
from jaxtyping import Bool, Float

from nostalgin_core.arrays import Gray

_TALL_PX = 32  # the height to which a word is brought
_MARK = 0.45  # of the word's height: what is lower is no letter


def parted(
    image: Gray, corners: Float[np.ndarray, "4 2"], text: str, *, clear: float = 1.4
) -> str:
    """Put a space into a word at its widest gap between two digits.

    The word is returned as it is unless as many letters are seen as were read, and one
    gap between digits is `clear` times as wide as every other.
    """
    letters = _runs(_word(image, corners))
    if len(letters) != len(text):
        return text
    gaps = [
        right[0] - left[1] if text[i : i + 2].isdigit() else 0
        for i, (left, right) in enumerate(pairwise(letters))
    ]
    order = np.argsort(gaps)[::-1]
    if len(gaps) < 2 or gaps[order[0]] < clear * max(1, gaps[order[1]]):
        return text
    place = int(order[0]) + 1
    return f"{text[:place]} {text[place:]}"


def _word(image: Gray, corners: Float[np.ndarray, "4 2"]) -> Bool[np.ndarray, "y x"]:
    """Straighten a word and tell ink from ground; ink is what there is less of."""
    width = np.linalg.norm(corners[1] - corners[0])
    height = max(1.0, float(np.linalg.norm(corners[3] - corners[0])))
    size = (max(4, round(_TALL_PX * float(width) / height)), _TALL_PX)
    ends = np.array([[0, 0], [size[0], 0], size, [0, size[1]]], np.float32)
    word_from_image = cv2.getPerspectiveTransform(corners.astype(np.float32), ends)
    straight = cv2.warpPerspective(image, word_from_image, size)
    _, ink = cv2.threshold(straight, 0, 1, cv2.THRESH_BINARY | cv2.THRESH_OTSU)
    return (ink if ink.mean() < 0.5 else 1 - ink).astype(bool)


def _runs(ink: Bool[np.ndarray, "y x"]) -> list[tuple[int, int]]:
    """List the runs of columns that hold a letter, first and last plus one."""
    rows = np.flatnonzero(ink.any(axis=1))
    if not len(rows):
        return []
    tall = np.ptp(rows) + 1
    filled = ink.any(axis=0)
    top = np.where(filled, ink.argmax(axis=0), 0)
    low = np.where(filled, len(ink) - 1 - ink[::-1].argmax(axis=0), -1)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], filled, [0]]).astype(np.int8)))
    runs = [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]
    return [
        (a, b) for a, b in runs if low[a:b].max() - top[a:b].min() + 1 >= _MARK * tall
    ]
