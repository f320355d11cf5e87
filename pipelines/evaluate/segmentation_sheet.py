"""A sheet of photographs for each kind of error: what was found beside what is there.

At the left the photo with all fronts found, at the right with those labelled, what
hides them dark red. Of the fronts that an error is about, the labelled one and the one
found that has most of it are outlined red; targets, called or labelled, yellow.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final, Protocol

import cv2
import numpy as np
from jaxtyping import UInt8

from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.records import Matted
from pipelines.evaluate.labels import Truth
from pipelines.evaluate.segmentation_kinds import WRONG, Kinds, count

TALL_PX: Final = 360  # of a photograph on a page
WIDE_PX: Final = 400  # of a photograph at most
COLUMNS, ROWS = 2, 4
CAPTION_PX: Final = 20
GAP_PX: Final = 8
PALE: Final = 0.45  # how much of a front's colour lies on the photo
COLOURS: Final = (
    (90, 200, 90),
    (200, 160, 60),
    (180, 90, 200),
    (80, 200, 220),
    (220, 120, 120),
    (120, 120, 240),
)
HIDING, RED, YELLOW, WHITE = (30, 30, 120), (40, 40, 255), (0, 230, 250), (255,) * 3

Colour = UInt8[np.ndarray, "h w 3"]


class Answered(Protocol):
    """What the stages made of a photo."""

    @property
    def matted(self) -> Matted: ...  # noqa: D102


def cells(
    file: Path, name: str, answer: Answered, true: Truth, told: Kinds
) -> dict[str, Colour]:
    """Draw a photo once for each kind of error that it has."""
    wrong = [kind for kind in WRONG if count(told.errors, kind)]
    if not wrong:
        return {}
    photo = _reduced(cv2.imread(str(file), cv2.IMREAD_GRAYSCALE), true.far.shape)
    labelled = [one for one in true.fronts if one.visible.any()]
    facades = answer.matted.facades
    hiding = [one.mask for one in answer.matted.occluders]
    left = _tinted(photo, [f.mask for f in facades], hiding)
    right = _tinted(photo, [one.visible for one in labelled], [true.hidden])
    for picture, masks in (
        (left, [f.mask for f in facades if f.target]),
        (right, [one.visible for one in labelled if one.target]),
    ):
        _outlined(picture, masks, YELLOW)
    result = {}
    for kind in wrong:
        ours, theirs = _concerned(told, kind)
        pair = [left.copy(), right.copy()]
        _outlined(pair[0], [facades[i].mask for i in ours], RED)
        _outlined(pair[1], [labelled[i].visible for i in theirs], RED)
        result[kind] = _captioned(np.hstack(pair), name)
    return result


def write(drawn: Mapping[str, Sequence[Colour]], folder: Path) -> list[Path]:
    """Write the pages as merged-01.png and so on; return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    files, full = [], ROWS * COLUMNS
    for kind in WRONG:
        every = drawn.get(kind, ())
        for number in range(-(-len(every) // full)):
            page = _page(every[number * full : (number + 1) * full])
            files.append(folder / f"{kind}-{number + 1:02d}.png")
            _, code = cv2.imencode(".png", page)
            files[-1].write_bytes(code.tobytes())
    return files


def _concerned(told: Kinds, kind: str) -> tuple[list[int], list[int]]:
    """Number the fronts found and the fronts labelled that one kind of error is of."""
    if kind == "wall":
        return [i for i, wall in enumerate(told.errors.walls) if wall], []
    theirs = [i for i, fate in enumerate(told.errors.fates) if fate == kind]
    holders = {told.errors.holders[i] for i in theirs}
    return sorted(holders - {-1}), theirs


def _reduced(photo: Gray | None, shape: tuple[int, int]) -> Colour:
    """Bring a photo to its size on a page."""
    gray = np.zeros(shape, np.uint8) if photo is None else photo
    scale = min(TALL_PX / gray.shape[0], WIDE_PX / gray.shape[1])
    size = (round(gray.shape[1] * scale), round(gray.shape[0] * scale))
    small = cv2.resize(gray, size, interpolation=cv2.INTER_AREA)
    return cv2.cvtColor(small, cv2.COLOR_GRAY2BGR).astype(np.uint8)


def _tinted(photo: Colour, fronts: Sequence[Mask], hiding: Sequence[Mask]) -> Colour:
    result = photo.copy()
    inks = [(mask, COLOURS[i % len(COLOURS)]) for i, mask in enumerate(fronts)]
    for mask, ink in [*inks, *((mask, HIDING) for mask in hiding)]:
        here = _small(mask, photo) > 0
        mixed = (1 - PALE) * photo[here] + PALE * np.array(ink)
        result[here] = mixed.astype(np.uint8)
    return result


def _outlined(
    picture: Colour, masks: Sequence[Mask], ink: tuple[int, int, int]
) -> None:
    for mask in masks:
        outlines, _ = cv2.findContours(
            _small(mask, picture), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE
        )
        cv2.drawContours(picture, outlines, -1, ink, 2)


def _small(mask: Mask, picture: Colour) -> np.ndarray:
    size = (picture.shape[1], picture.shape[0])
    return cv2.resize(mask.astype(np.uint8), size, interpolation=cv2.INTER_NEAREST)


def _captioned(pair: Colour, name: str) -> Colour:
    cell = np.zeros((CAPTION_PX + TALL_PX, pair.shape[1], 3), np.uint8)
    cell[CAPTION_PX : CAPTION_PX + pair.shape[0]] = pair
    at = (2, CAPTION_PX - 6)
    cv2.putText(cell, name, at, cv2.FONT_HERSHEY_SIMPLEX, 0.45, WHITE, 1, cv2.LINE_AA)
    return cell


def _page(every: Sequence[Colour]) -> Colour:
    tall, wide = np.max([cell.shape[:2] for cell in every], axis=0)
    rows = -(-len(every) // COLUMNS)
    page = np.zeros((rows * (tall + GAP_PX), COLUMNS * (wide + GAP_PX), 3), np.uint8)
    for i, cell in enumerate(every):
        y, x = (i // COLUMNS) * (tall + GAP_PX), (i % COLUMNS) * (wide + GAP_PX)
        page[y : y + tall, x : x + cell.shape[1]] = cell
    return page
