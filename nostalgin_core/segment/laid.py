"""A front is laid straight: its level lines become rows, its upright ones columns.

Fronts of one photo share the way up, and each has its own level direction, so that two
vanishing points lay a front straight. No lines are sought for it: every pixel that
shows an edge says where one passes, and weighs as much as the edge is strong.

Letters: (x, y) is a pixel, in halves of the frame's longer side from the frame's
middle; (g, h) the gradient of the tone there; a = (X, Y, W) a vanishing point. The edge
through (x, y) leads to a where

    g (X - x W) + h (Y - y W) = 0,

which is linear in a. The least squares of the sine of the angle between the two, with
Tukey's weights in a window that narrows, are an eigenvector of three rows.
"""

from dataclasses import dataclass, replace
from typing import Final

import cv2
import numpy as np
from jaxtyping import Float, Float32

from nostalgin_core.arrays import Mask, Matrix3
from nostalgin_core.records import Box

GRAIN_PX: Final = 1.0  # standard deviation of the blur before edges are measured
EDGE: Final = 0.02  # a pixel's change that counts as an edge; 1 is white beside black
CAP: Final = 0.06  # a stronger edge has no more say
STEEP, LEVEL = 2.2, 1.2  # how much faster than down it changes across, and vice versa
MOST: Final = 6_000  # pixels that speak for one direction
SOME: Final = 4_000  # pixels of a front that tell how far it reaches
FEWEST: Final = 50
MOST_SKEWED: Final = 1e9  # condition of a plane seen edge on
GATES_DEG: Final = (12.0, 7.2, 4.3, 2.6)  # beyond, an edge has no say, round by round
FAR: Final = 1e-4  # rad^2 that a vanishing point nearer than infinity must be worth
LEANING: Final = 2e-4  # and one that makes uprights lean, for cameras stand level
ENDS: Final = (0.3, 99.7)  # per cent of a front's pixels lie between its patch's sides
PAD_PX: Final = 2.0
LONGEST_PX: Final = 256  # of a patch
STRETCHED: Final = 4  # times as much of a front is cut off: its direction is a guess

Plane = Float32[np.ndarray, "h w"]
Direction = Float[np.ndarray, "3"]


@dataclass(frozen=True, slots=True, eq=False)
class Edges:
    """How fast the tone of a frame changes."""

    across: Plane
    down: Plane

    @property
    def half_px(self) -> float:
        """The unit of x and y, half of the frame's longer side."""
        return max(self.across.shape) / 2

    @property
    def middle_px(self) -> Float[np.ndarray, "2"]:
        """The frame's middle."""
        return np.array(self.across.shape[::-1]) / 2


@dataclass(frozen=True, slots=True, eq=False)
class Patch:
    """Where a front that was laid straight lies in the picture."""

    photo_from_patch: Matrix3
    size: tuple[int, int]  # w, h

    def of(self, plane: Plane) -> Float32[np.ndarray, "high wide"]:
        """Lay a plane of the picture straight."""
        flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
        laid = cv2.warpPerspective(plane, self.photo_from_patch, self.size, flags=flags)
        return laid.astype(np.float32, copy=False)

    def enlarged(self, shape: tuple[int, int], frame: Box) -> "Patch":
        """Tell where it lies in a photo, of whose frame the picture was a small copy.

        `shape` is the copy's.
        """
        scale = np.array([frame.x1 - frame.x0, frame.y1 - frame.y0]) / shape[::-1]
        photo_from_copy = np.diag([*scale, 1.0])
        photo_from_copy[:2, 2] = (scale - 1) / 2 + (frame.x0, frame.y0)
        return replace(self, photo_from_patch=photo_from_copy @ self.photo_from_patch)


def edges(light: Plane) -> Edges:
    """Measure how fast a frame's tone, 0 to 1, changes from pixel to pixel."""
    smooth = cv2.GaussianBlur(light, (0, 0), GRAIN_PX)
    across, down = (
        cv2.Sobel(smooth, cv2.CV_32F, dx, dy, ksize=1, scale=0.5)
        for dx, dy in ((1, 0), (0, 1))
    )
    return Edges(across.astype(np.float32), down.astype(np.float32))


def upright(seen: Edges, where: Mask) -> Direction:
    """Find where the upright edges of all fronts meet; straight down if few do."""
    start = np.array([0.0, 1.0, 0.0])
    told = _voices(seen, where, steep=True)
    return _meeting(told, start, np.array([LEANING, 0.0, FAR / 2]))


def level(seen: Edges, where: Mask) -> Direction:
    """Find where the level edges of one front meet, from the direction of most."""
    told = _voices(seen, where, steep=False)
    if told.shape[1] < FEWEST:
        return np.array([1.0, 0.0, 0.0])
    _, _, across, down = told
    weight = np.minimum(np.hypot(across, down), CAP)
    slopes = np.degrees(np.arctan(-across / down))
    votes, sides = np.histogram(slopes, bins=72, range=(-45, 45), weights=weight)
    best = int(np.convolve(votes, [1, 2, 3, 2, 1], "same").argmax())
    slope = np.radians((sides[best] + sides[best + 1]) / 2)
    start = np.array([np.cos(slope), np.sin(slope), 0.0])
    return _meeting(told, start, np.array([0.0, 0.0, FAR]))


def _voices(seen: Edges, where: Mask, *, steep: bool) -> Float[np.ndarray, "4 n"]:
    """List x, y, g and h of the edges in a mask that may be upright, or level."""
    rows, columns = _bounds(where)
    across, down = seen.across[rows, columns], seen.down[rows, columns]
    a, d = np.abs(across), np.abs(down)
    kept = where[rows, columns] & (np.maximum(a, d) > EDGE)
    kept &= (a > STEEP * d) if steep else (d > LEVEL * a)
    index = np.flatnonzero(kept)
    index = index[:: len(index) // MOST + 1]
    y, x = np.divmod(index, kept.shape[1])
    middle = seen.middle_px
    return np.stack(
        [
            (x + columns.start - middle[0]) / seen.half_px,
            (y + rows.start - middle[1]) / seen.half_px,
            across.ravel()[index],
            down.ravel()[index],
        ]
    ).astype(np.float64)


def _meeting(
    told: Float[np.ndarray, "4 n"], start: Direction, prior: Float[np.ndarray, "3"]
) -> Direction:
    """Fit a vanishing point to edges, near a first guess."""
    if told.shape[1] < FEWEST:
        return start
    x, y, g, h = told
    lines = np.stack([g, h, -(g * x + h * y)])
    steepness = g * g + h * h
    strength = np.minimum(np.sqrt(steepness), CAP)
    point = start
    for gate in np.radians(GATES_DEG):
        ray = (point[0] - x * point[2]) ** 2 + (point[1] - y * point[2]) ** 2
        scale = ray * steepness + np.finfo(np.float64).tiny
        sine2 = (point @ lines) ** 2 / scale
        weight = np.maximum(1 - sine2 / gate**2, 0) ** 2 * strength
        moments = (lines * (weight / scale)) @ lines.T / max(weight.sum(), 1e-9)
        _, axes = np.linalg.eigh(moments + np.diag(prior))
        found = axes[:, 0]
        point = -found if found @ point < 0 else found
    return point


def patch(seen: Edges, front: Mask, up: Direction, along: Direction) -> Patch | None:
    """Lay a front straight, in pixels as large as at its middle; None if that fails.

    `up` and `along` are the vanishing points of its columns and rows.
    """
    rows, columns = _bounds(front)
    y, x = np.nonzero(front[rows, columns])
    points = np.stack([x + columns.start, y + rows.start, np.ones(len(x))])
    frame_from_plane = _plane(seen, points[:2].mean(axis=1), up, along)
    if frame_from_plane is None:
        return None
    few = points[:, :: len(x) // SOME + 1]
    there = np.linalg.solve(frame_from_plane, few)
    there = there[:2, there[2] > 0] / there[2, there[2] > 0]
    if there.shape[1] < FEWEST:
        return None
    low, high = np.percentile(there, ENDS, axis=1)
    low, high = low - PAD_PX, high + PAD_PX
    span = np.minimum(high - low, STRETCHED * LONGEST_PX)
    size = np.maximum(np.ceil(span * min(1, LONGEST_PX / span.max())), 1)
    plane_from_patch = np.eye(3)
    plane_from_patch[:2, :2] = np.diag((high - low) / size)
    plane_from_patch[:2, 2] = low
    return Patch(frame_from_plane @ plane_from_patch, (int(size[0]), int(size[1])))


def _plane(
    seen: Edges, middle_px: Float[np.ndarray, "2"], up: Direction, along: Direction
) -> Matrix3 | None:
    """Map a front's plane to the frame, pixel by pixel at a point, its origin."""
    centre = (middle_px - seen.middle_px) / seen.half_px
    columns = []
    for point, axis in ((along, 0), (up, 1)):
        way = point[:2] - centre * point[2]
        columns.append(point / (np.copysign(np.hypot(*way), way[axis]) * seen.half_px))
    frame_from_unit = np.diag([seen.half_px, seen.half_px, 1.0])
    frame_from_unit[:2, 2] = seen.middle_px
    mapped = frame_from_unit @ np.column_stack([*columns, [*centre, 1.0]])
    sound = np.isfinite(mapped).all() and np.linalg.cond(mapped) < MOST_SKEWED
    return mapped if sound else None


def _bounds(mask: Mask) -> tuple[slice, slice]:
    """Cut out the rows and columns that a mask, which is not empty, reaches."""
    rows, columns = np.flatnonzero(mask.any(1)), np.flatnonzero(mask.any(0))
    return slice(int(rows[0]), int(rows[-1]) + 1), slice(
        int(columns[0]), int(columns[-1]) + 1
    )
