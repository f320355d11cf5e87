"""The lines of three methods on one photo, side by side (the paper's figure of them).

Each panel shows the lines that one method lets speak for a photo's fronts, coloured by
what they vote for once the later steps, the same for all three, have found the camera
and the directions: up red, each front's horizontal in a colour of its own; a line that
misses every point by t_a or more is gray and thin. The table beside it counts them.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import cv2
import numpy as np
from jaxtyping import Float, Int, UInt8

from nostalgin_core.arrays import Homogeneous, Mask
from nostalgin_core.records import Matted, Photo
from nostalgin_core.rectify import camera, lines, orient, upright, vanish

UP = (60, 60, 240)
ACROSS: Final = (
    (80, 200, 60),
    (240, 150, 40),
    (40, 190, 250),
    (220, 80, 220),
    (200, 220, 60),
)
SILENT = (70, 70, 70)
EDGE_PX = 4  # as `orient` leaves out
TITLE_PX = 26
QUALITY = 88
GAP = 8

Colour = UInt8[np.ndarray, "h w 3"]


@dataclass(frozen=True, slots=True, eq=False)
class Voted:
    """A method's lines, in photo pixels, and what each votes for."""

    lines: Float[np.ndarray, "n 4"]
    axis: Int[np.ndarray, " n"]  # -1 nothing, 0 up, then each front's horizontal


def voted(photo: Photo, matted: Matted, detector: lines.Detector) -> Voted:
    """Find lines, and let each vote for the nearest point of the world they lead to.

    A line belongs to the front that most of it lies on, and votes for that front's
    horizontal point or for the vertical one; of no front, it is left out.
    """
    if not matted.facades:
        return Voted(np.empty((0, 4)), np.empty(0, np.intp))
    world = orient.orient(photo, matted.facades, detector=detector).world
    clear = [orient.unhidden(facade) for facade in matted.facades]
    anywhere = np.any(clear, axis=0) & inside_frame(photo)
    _, found = orient.detect(photo, anywhere, detector=detector)
    share = np.array([vanish.inside(found, mask) for mask in clear])
    front = share.argmax(axis=0)
    on_front = share.max(axis=0) >= orient.LEAST_INSIDE
    found, front = found[on_front], front[on_front]
    missed = vanish.distance_deg(points_px(photo, world), found)
    rows = np.arange(len(found))
    up, across = missed[0], missed[front + 1, rows]
    axis = np.where(up < across, 0, front + 1)
    silent = np.minimum(up, across) >= vanish.ALIGNED_DEG
    return Voted(found, np.where(silent, -1, axis).astype(np.intp))


def inside_frame(photo: Photo) -> Mask:
    """Tell where the exposed frame is, less its own edge, which is a long line."""
    x0, y0, x1, y1 = photo.frame
    inside = np.zeros(photo.image.shape, bool)
    inside[y0 + EDGE_PX : y1 - EDGE_PX, x0 + EDGE_PX : x1 - EDGE_PX] = True
    return inside


def points_px(photo: Photo, world: upright.Upright) -> Homogeneous:
    """Carry the world's vanishing points to photo pixels: up, then each front's."""
    prior = camera.prior_focal_px(photo.frame)
    points = upright.vanishing_points(world.parameters)
    return points @ camera.matrix(prior, photo.frame).T


def figures(found: Voted) -> dict[str, Any]:
    """Count a method's lines, and by length the share that votes for nothing."""
    length = vanish.lengths(found.lines)
    whole = float(length.sum())
    silent = float(length[found.axis < 0].sum())
    return {
        "lines": len(length),
        "median_px": float(np.median(length)) if len(length) else None,
        "up_lines": int(np.count_nonzero(found.axis == 0)),
        "level_lines": int(np.count_nonzero(found.axis > 0)),
        "silent_percent": 100 * silent / whole if whole else None,
    }


def panel(photo: Photo, found: Voted, title: str) -> Colour:
    """Draw a method's lines over the photo, paled; silent ones first and thinner."""
    pale = (255 - (255 - photo.image.astype(np.float32)) * 0.45).astype(np.uint8)
    drawn = cv2.cvtColor(pale, cv2.COLOR_GRAY2BGR)
    for axis in np.unique(found.axis):
        rows = found.lines[found.axis == axis]
        colour = SILENT if axis < 0 else UP if axis == 0 else ACROSS[axis % len(ACROSS)]
        ends = np.rint(rows.reshape(-1, 2, 2) * 16).astype(np.int32)
        thick = 1 if axis < 0 else 2
        cv2.polylines(drawn, list(ends), False, colour, thick, cv2.LINE_AA, 4)  # noqa: FBT003
    strip = np.full((TITLE_PX, drawn.shape[1], 3), 255, np.uint8)
    cv2.putText(
        strip, title, (4, 18), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (0, 0, 0), 1, cv2.LINE_AA
    )
    return np.vstack([strip, drawn]).astype(np.uint8)


def side_by_side(
    photo: Photo, matted: Matted, detectors: Mapping[str, lines.Detector]
) -> tuple[Colour, dict[str, dict[str, Any]]]:
    """Draw every method's panel, and give its figures."""
    panels: list[np.ndarray] = []
    table: dict[str, dict[str, Any]] = {}
    for name, detector in detectors.items():
        found = voted(photo, matted, detector)
        table[name] = figures(found)
        row = table[name]
        title = (
            f"{name}: {row['lines']} lines, {row['silent_percent'] or 0:.0f}% silent"
        )
        panels.append(panel(photo, found, title))
        panels.append(np.full((panels[0].shape[0], GAP, 3), 255, np.uint8))
    return np.hstack(panels[:-1]).astype(np.uint8), table


def write(
    photo: Photo,
    matted: Matted,
    detectors: Mapping[str, lines.Detector],
    file: Path,
) -> dict[str, dict[str, Any]]:
    """Write the picture as JPEG, and give each method's figures."""
    file.parent.mkdir(parents=True, exist_ok=True)
    picture, table = side_by_side(photo, matted, detectors)
    cv2.imwrite(str(file), picture, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])
    return table


def averaged(tables: list[dict[str, dict[str, Any]]]) -> dict[str, dict[str, Any]]:
    """Average each method's figures over photos, those without a line left out."""
    made: dict[str, dict[str, Any]] = {}
    for name in tables[0] if tables else ():
        rows = [table[name] for table in tables if table[name]["lines"]]
        made[name] = {"photographs": len(tables)} | {
            key: float(np.mean([row[key] for row in rows])) if rows else None
            for key in tables[0][name]
        }
    return made
