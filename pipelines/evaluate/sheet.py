"""A contact sheet: every labelled photograph with its quads, beside its elevations.

Four photographs a page, and pages are numbered. In the photo, labelled quads are drawn
white, ours of target fronts green and of others yellow; a labelled front that was
refused is red. Each elevation has its front's number, its method's first letter, its
aspect ratio and the labelled quad's worst angle in degrees; black was not seen.
"""

from pathlib import Path
from typing import Final

import cv2
import numpy as np
from jaxtyping import UInt8

from nostalgin_core.arrays import Corners
from nostalgin_core.records import Elevation, Rejection
from pipelines.evaluate.labelled import Labelled, worst_angle_deg

CELL: Final = (640, 790)  # height, width of a photograph's place on a page
PHOTO: Final = (600, 400)
ROWS, COLUMNS = 2, 2
GAP = 10
CAPTION_PX = 16
WHITE, GREEN, YELLOW, RED = (
    (255, 255, 255),
    (60, 220, 60),
    (0, 220, 240),
    (40, 40, 250),
)
BACKGROUND = 40
SHOWN = 6  # elevations beside a photo, targets first

Colour = UInt8[np.ndarray, "h w 3"]


def write(photographs: list[Labelled], folder: Path) -> list[Path]:
    """Write the pages as page-01.jpg and so on; return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    full = ROWS * COLUMNS
    pages = -(-len(photographs) // full)
    files = []
    for number in range(pages):
        cells = [cell(one) for one in photographs[number * full : (number + 1) * full]]
        page = np.full(
            (ROWS * CELL[0] + 24, COLUMNS * CELL[1], 3), BACKGROUND, np.uint8
        )
        for i, one in enumerate(cells):
            y, x = (i // COLUMNS) * CELL[0], (i % COLUMNS) * CELL[1]
            page[y : y + CELL[0], x : x + CELL[1]] = one
        _say(page, f"page {number + 1} of {pages}", (GAP, page.shape[0] - 8))
        files.append(folder / f"page-{number + 1:02d}.jpg")
        cv2.imwrite(str(files[-1]), page, [cv2.IMWRITE_JPEG_QUALITY, 88])
    return files


def cell(one: Labelled) -> Colour:
    """Draw one photograph: quads at the left, elevations at the right."""
    made = np.full((*CELL, 3), BACKGROUND, np.uint8)
    photo = quads(one)
    h, w = photo.shape[:2]
    made[CAPTION_PX + 8 : CAPTION_PX + 8 + h, GAP : GAP + w] = photo
    _say(made, str(one.label["id"]), (GAP, CAPTION_PX))
    left = GAP + PHOTO[1] + GAP
    right = elevations(one, (PHOTO[0], CELL[1] - left - GAP))
    made[CAPTION_PX + 8 : CAPTION_PX + 8 + PHOTO[0], left : CELL[1] - GAP] = right
    return made


def quads(one: Labelled) -> Colour:
    """Draw labelled and found quads over the photo, with a margin for what lies out."""
    image = one.photo.image
    h, w = image.shape
    scale = min(PHOTO[0] / h, PHOTO[1] / w)
    size = (round(w * scale), round(h * scale))
    gray = cv2.resize(image, size, interpolation=cv2.INTER_AREA)
    drawn = cv2.cvtColor(gray, cv2.COLOR_GRAY2BGR)
    for i, (front, result) in enumerate(zip(one.fronts, one.results, strict=True)):
        labelled = np.array(front["quad"], np.float64)
        refused = isinstance(result, Rejection)
        _outline(drawn, labelled * scale, RED if refused else WHITE, 1)
        if isinstance(result, Elevation):
            colour = GREEN if front.get("target") else YELLOW
            _outline(drawn, result.quad * scale, colour, 1)
        x, y = labelled.mean(axis=0) * scale
        at = (int(np.clip(x, 4, size[0] - 16)), int(np.clip(y, 14, size[1] - 4)))
        _say(drawn, str(i), at)
    return drawn.astype(np.uint8)


def elevations(one: Labelled, size: tuple[int, int]) -> Colour:
    """Lay the elevations out in rows of two, targets first."""
    panel = np.full((*size, 3), BACKGROUND, np.uint8)
    ranked = sorted(
        enumerate(zip(one.fronts, one.results, strict=True)),
        key=lambda item: not item[1][0].get("target"),
    )[:SHOWN]
    rows = max(1, -(-len(ranked) // 2))
    room = (size[0] // rows - CAPTION_PX - 4, size[1] // 2 - 4)
    for place, (i, (front, result)) in enumerate(ranked):
        y = (place // 2) * (size[0] // rows)
        x = (place % 2) * (size[1] // 2)
        _say(panel, _caption(i, front, result), (x, y + 12))
        if isinstance(result, Elevation):
            h, w = result.image.shape
            scale = min(room[0] / h, room[1] / w)
            fitted = (max(1, round(w * scale)), max(1, round(h * scale)))
            small = cv2.resize(result.image, fitted, interpolation=cv2.INTER_AREA)
            top = y + CAPTION_PX
            panel[top : top + fitted[1], x : x + fitted[0]] = small[..., None]
    return panel


def _caption(i: int, front: dict[str, object], result: Elevation | Rejection) -> str:
    """Say what became of a front."""
    mark = "*" if front.get("target") else ""
    if isinstance(result, Rejection):
        return f"{i}{mark} {result.reason}"
    angle = worst_angle_deg(front, result)
    return f"{i}{mark} {result.method[0]} {result.aspect:.2f} {angle:.1f}"


def _outline(image: Colour, quad: Corners, colour: tuple[int, ...], px: int) -> None:
    """Draw a quad to a fraction of a pixel; far corners are cut by the image."""
    corners = np.rint(np.clip(quad, -2000, 4000) * 16).astype(np.int32)
    cv2.polylines(image, [corners], True, colour, px, cv2.LINE_AA, 4)  # noqa: FBT003


def _say(image: Colour, words: str, at: tuple[int, int]) -> None:
    """Write a few words, dark-edged, so that they can be read on anything."""
    for colour, px in (((0, 0, 0), 3), (WHITE, 1)):
        cv2.putText(
            image, words, at, cv2.FONT_HERSHEY_SIMPLEX, 0.42, colour, px, cv2.LINE_AA
        )
