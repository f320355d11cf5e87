"""Outlines and quads as people write them: points of a photo, x,y x,y ..., in pixels.

An outline is of a whole front, cars and people before it included; it has no crossing
and lies in the photo. A quad has the front's four corners, in whatever order they are
written; where the photo cuts the front off they may lie outside of it.
"""

import re
from collections.abc import Sequence
from typing import Final

import numpy as np
import shapely
from jaxtyping import Float

from pipelines.corrections.words import numeric
from pipelines.index.cells import quoted

FEWEST, MOST = 4, 1000  # points of an outline
LEAST_AREA: Final = 400.0  # square pixels: nothing can be seen on less
LEAST_SIDE: Final = 16.0  # of a quad, in pixels: the same
FARTHEST: Final = 100_000.0  # pixels: no photo is so wide
SLACK: Final = 1.0  # pixels by which an outline may leave its photo
OUTSIDE: Final = 0.5  # of the photo's side by which a quad may
FLATTEST: Final = 0.02  # of a corner's sides multiplied: below, three are in line

Points = Float[np.ndarray, "n 2"]


def read(value: str) -> Points:
    """Read points; commas, semicolons and blanks part their numbers.

    Raises:
        ValueError: if a number is none, or one has no partner.
    """
    words = [one for one in re.split(r"[\s,;]+", value.strip()) if one]
    if len(words) > 2 * MOST:
        count = len(words) // 2
        raise ValueError(f"has {count:,} points, more than {MOST:,}: fewer will do")
    if len(words) % 2:
        raise ValueError("has a number without a partner: write x,y x,y x,y x,y")
    try:
        points = np.array(words, np.float64).reshape(-1, 2)
    except ValueError as problem:
        raise ValueError(no_number(words)) from problem
    if np.any(np.isnan(points)):
        raise ValueError(no_number(words))
    if not np.all(np.abs(points) <= FARTHEST):
        raise ValueError(f"has a number beyond {FARTHEST:,.0f} pixels: mend it")
    return points


def no_number(some: Sequence[str]) -> str:
    """Name the first word that is no number, with the remedy."""
    first = next((one for one in some if not numeric(one)), "")
    return f"has {quoted(first)}, which is no number: write x,y x,y x,y x,y"


def written(points: Points) -> str:
    """Write points as they go into keys: to a hundredth of a pixel."""
    return " ".join(f"{x:.2f},{y:.2f}" for x, y in np.round(points, 2) + 0.0)


def outline(value: str) -> Points:
    """Read the outline of a front.

    Raises:
        ValueError: if it is none, with the remedy.
    """
    points = read(value)
    if len(points) < FEWEST:
        raise ValueError(f"has {len(points)} points: a front has four corners at least")
    shape = shapely.Polygon(points)
    if not shape.is_valid:
        where = shapely.is_valid_reason(shape).replace("Self-intersection", "")
        raise ValueError(f"crosses or touches itself near {where[:40]}: draw it anew")
    if shape.area < LEAST_AREA:
        raise ValueError(f"covers {shape.area:.0f} pixels: draw it in the photo's own")
    return points


def quad(value: str) -> Points:
    """Read the four corners of a front, clockwise from the top left.

    Raises:
        ValueError: if they are none, with the remedy.
    """
    points = read(value)
    if len(points) != 4:
        raise ValueError(f"has {len(points)} corners: a quad has four")
    middle = points.mean(axis=0)
    around = np.arctan2(*(points - middle).T[::-1])  # clockwise, since y points down
    ordered = points[np.argsort(around, kind="stable")]
    first = int(np.argmin(ordered.sum(axis=1)))
    corners = np.roll(ordered, -first, axis=0)
    after = np.roll(corners, -1, axis=0) - corners
    before = np.roll(after, 1, axis=0)
    sides = np.hypot(*after.T)
    if sides.min() < LEAST_SIDE:
        raise ValueError(f"has a side of {sides.min():.0f} pixels: draw it larger")
    turns = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    if np.any(turns < FLATTEST * sides * np.roll(sides, 1)):
        raise ValueError("has a corner that is none: draw the front's four corners")
    return corners


def misfit(what: str, points: Points, size_px: tuple[int, int]) -> str:
    """Tell how a shape leaves a photo of that width and height, if it does."""
    size = np.array(size_px, np.float64)
    slack = SLACK if what == "mask" else OUTSIDE * size
    inside = shapely.box(0, 0, *size).intersection(shapely.Polygon(points))
    beyond = np.any(points < -slack) or np.any(points > size - 1 + slack)
    if beyond or inside.area < LEAST_AREA:
        return f"leaves its photo of {size_px[0]} x {size_px[1]} pixels: draw it anew"
    return ""
