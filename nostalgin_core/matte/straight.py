"""A front's sides and roof are straight lines, and the image shows where they run.

The network's masks are ragged and round: a texel is 5 to 10 px wide. Where a front's
left, right or upper outline lies along a line, the line is moved and tilted to the
strongest edge nearby, and the front's probability becomes a ramp across it. What a
front gives up beside a neighbour falls to the neighbour, lest a gap open. The foot,
which cars and people hide, is left alone.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import cv2
import numpy as np
from jaxtyping import Float, Float32

from nostalgin_core.arrays import Gray, Mask, Probability
from nostalgin_core.records import Box, Instance, Photo

REACH_PX: Final = 8  # that a line may move: a texel of a large front
TILTS_PX: Final = (-5.0, -2.5, 0.0, 2.5, 5.0)  # of a line's ends, to either side
CLEARLY: Final = 1.3  # times the edge strength where the line stands
LEAST: Final = 0.015  # mean edge strength worth following, film grain shows 0.005
FARTHER: Final = 0.001  # edge strength that a pixel's way must be worth
CAP: Final = 0.06  # a stronger edge has no more say: a few bright spots are no line
GRAIN_PX: Final = 0.7  # standard deviation of the blur before edges are measured
RAMP_PX: Final = 8.0  # from a probability of one half to 0 or 1
CLOSE_PX: Final = 3.0  # what lies this near a line is on it
STRAIGHT: Final = 0.5  # of a side's rows must be
TALL: Final = 0.35  # of the front's height must lie between the line's ends
STEEPEST: Final = 0.35  # px a px off the upright, or off the level for a roof
FOOT: Final = 0.9  # of the height: what is below is often hidden
FEWEST: Final = 24  # rows
OURS: Final = 0.55  # at least, on the front's side of a line
GAP_PX: Final = 4  # between neighbours, which is closed where one moves away
PAD_PX: Final = 12  # round a box: a line may leave it

_View = Callable[[np.ndarray], np.ndarray]


class Line(NamedTuple):
    """Runs at the column `at + slope * row`, from row `first` to row `last`."""

    at: float
    slope: float
    first: int
    last: int


@dataclass(frozen=True, slots=True, eq=False)
class _Side:
    view: _View  # turns the side to the left
    across: int  # the axis that the view's rows run along
    stop: float  # share of the extent that is looked at


def _as_it_is(image: np.ndarray) -> np.ndarray:
    return image


def _mirrored(image: np.ndarray) -> np.ndarray:
    return image[:, ::-1]


def _on_its_side(image: np.ndarray) -> np.ndarray:
    return image.T


SIDES: Final = (
    _Side(_as_it_is, 1, FOOT),
    _Side(_mirrored, 1, FOOT),
    _Side(_on_its_side, 0, 1.0),
)


def straight(photo: Photo, found: Sequence[Instance]) -> tuple[Instance, ...]:
    """Put the sides and roofs of fronts onto the edges that the image shows.

    The surest front comes first. All that is no front stays as it is.
    """
    fronts = [one for one in found if one.category == "facade"]
    if not fronts:
        return tuple(found)
    claims = [_padded(one, photo.frame) for one in fronts]
    strengths = edge_strengths(photo.image)
    for one in sorted(claims, key=lambda claim: -claim.score):
        here = np.s_[one.box.y0 : one.box.y1, one.box.x0 : one.box.x1]
        for side in SIDES:
            before = one.probability > 0.5
            line = _line(one, side, strengths[side.across][here], photo.frame)
            if line is None:
                continue
            draw(side.view(one.probability), line)
            _yield(one, before, [c for c in claims if c is not one], side.across)
    moved = iter(claims)
    return tuple(next(moved) if one.category == "facade" else one for one in found)


def edge_strengths(image: Gray) -> tuple[Float32[np.ndarray, "h w"], ...]:
    """Measure how fast the image changes down and across, per pixel, at most `CAP`."""
    light = cv2.GaussianBlur(image.astype(np.float32) / 255, (0, 0), GRAIN_PX)
    result = []
    for turned in ((0, 1), (1, 0)):
        change = cv2.Sobel(light, cv2.CV_32F, turned[0], turned[1], ksize=1, scale=0.5)
        result.append(np.minimum(np.abs(change), np.float32(CAP)))
    return tuple(result)


def _line(
    front: Instance, side: _Side, strength: Float32[np.ndarray, "h w"], frame: Box
) -> Line | None:
    """Find the line that a side should follow, None where it follows none."""
    mask = side.view(front.probability > 0.5)
    rows = np.flatnonzero(mask.any(1))
    if len(rows) < FEWEST:
        return None
    tall = rows[-1] - rows[0]
    rows = rows[rows <= rows[0] + side.stop * tall]
    outline = np.argmax(mask[rows], axis=1) - 0.5
    inner = side.view(_inner(front.box, frame))[rows, outline.astype(int)]
    line = fitted(rows[inner], outline[inner], least=STRAIGHT * len(rows))
    if line is None or line.last - line.first < TALL * tall:
        return None
    near = np.abs(outline - line.at - line.slope * rows) < CLOSE_PX
    return moved(line, rows[near & inner], side.view(strength))


def _inner(box: Box, frame: Box) -> Mask:
    """Mark what lies farther than a little from the frame, which cuts fronts off."""
    ys, xs = np.arange(box.y0, box.y1), np.arange(box.x0, box.x1)
    away = [
        np.minimum(places - low, high - 1 - places) > CLOSE_PX
        for places, low, high in ((ys, frame.y0, frame.y1), (xs, frame.x0, frame.x1))
    ]
    return np.logical_and.outer(*away)


def fitted(
    rows: np.ndarray, places: Float[np.ndarray, " n"], *, least: float
) -> Line | None:
    """Fit a line that a fifth may miss, None if fewer than `least` places lie on it.

    It starts from the median slope between the halves and goes on with Tukey's weights.
    """
    n, half = len(rows), len(rows) // 2
    if n < max(FEWEST, least):
        return None
    ahead = (places[half : 2 * half] - places[:half]) / (
        rows[half : 2 * half] - rows[:half]
    )
    slope = float(np.median(ahead))
    at = float(np.median(places - slope * rows))
    for reach in (8.0, 5.0, 4.0, 4.0):
        weight = np.maximum(1 - ((places - at - slope * rows) / reach) ** 2, 0.01) ** 2
        y, x = np.average(rows, weights=weight), np.average(places, weights=weight)
        slope = np.sum(weight * (rows - y) * (places - x)) / np.sum(
            weight * (rows - y) ** 2
        )
        at = x - slope * y
    near = np.abs(places - at - slope * rows) < CLOSE_PX
    if np.count_nonzero(near) < least or abs(slope) > STEEPEST:
        return None
    return Line(float(at), float(slope), int(rows[near][0]), int(rows[near][-1]))


def moved(line: Line, rows: np.ndarray, strength: Float32[np.ndarray, "h w"]) -> Line:
    """Move and tilt a line to the strongest edge nearby, if that is clearly stronger.

    The strength of an edge is its mean over the rows, less a little for the way there.
    """
    middle = (rows[0] + rows[-1]) / 2
    lever = (rows - middle) / max((rows[-1] - rows[0]) / 2, 1)
    stands = line.at + line.slope * rows
    last = strength.shape[1] - 1
    steps = np.arange(-REACH_PX, REACH_PX + 1)
    best, here = (0.0, 0.0, 0.0), 0.0
    for tilt in TILTS_PX:
        places = np.rint(stands + tilt * lever)[None] + steps[:, None]
        at = np.clip(places, 0, last).astype(np.intp)
        found = strength[rows[None], at].mean(1)
        if tilt == 0:
            here = float(found[np.abs(steps) <= 1].max())
        found = found - FARTHER * np.abs(steps)
        top = int(np.argmax(found))
        best = max(best, (float(found[top]), float(steps[top]), tilt))
    strongest, step, tilt = best
    if strongest < max(CLEARLY * here, LEAST):
        return line
    slope = tilt / max((rows[-1] - rows[0]) / 2, 1)
    return line._replace(at=line.at + step - slope * middle, slope=line.slope + slope)


def draw(probability: Probability, line: Line) -> None:
    """Put a front's left outline on a line, in place, where it runs near it."""
    inside = probability > 0.5
    rows = np.arange(line.first, line.last + 1)
    rows = rows[inside[rows].any(1)]
    places = line.at + line.slope * rows
    before = np.argmax(inside[rows], axis=1) - 0.5
    near = np.abs(before - places) < RAMP_PX + REACH_PX
    rows, places, before = rows[near], places[near], before[near]
    away = np.arange(probability.shape[1])[None] - places[:, None]
    ramp = np.clip(0.5 + away / (2 * RAMP_PX), 0, 1).astype(np.float32)
    likely = probability[rows]
    deep = np.where(likely > 0.5, likely, np.float32(OURS))
    less = np.minimum(likely, np.float32(1 - OURS))
    drawn = np.where(away < 0, np.minimum(ramp, less), np.maximum(ramp, deep))
    strip = away < np.maximum(RAMP_PX, before - places + 1)[:, None]
    probability[rows] = np.where(strip, drawn, likely)


def _yield(
    front: Instance, before: Mask, others: Sequence[Instance], across: int
) -> None:
    """Give neighbours what a front gave up beside them, and what lies between.

    What it took from them needs no word: who is surer has it.
    """
    after = front.probability > 0.5
    lost = before & ~after
    if not lost.any():
        return
    for other in others:
        mine, theirs = _common(front.box, other.box)
        if not lost[mine].any():
            continue
        there = other.probability[theirs]
        between = _near(lost[mine], across, GAP_PX) & ~after[mine]
        between &= _near(there > 0.5, across, PAD_PX)
        np.maximum(there, 1 - front.probability[mine], out=there, where=between)


def _near(mask: Mask, across: int, reach_px: int) -> Mask:
    """Add what lies within a distance along an axis."""
    long = 2 * reach_px + 1
    kernel = np.ones((1, long) if across else (long, 1), np.uint8)
    return cv2.dilate(mask.astype(np.uint8), kernel) > 0


def _common(one: Box, other: Box) -> tuple[tuple[slice, slice], tuple[slice, slice]]:
    """Cut what two boxes share out of either."""
    x0, y0 = max(one.x0, other.x0), max(one.y0, other.y0)
    x1, y1 = max(x0, min(one.x1, other.x1)), max(y0, min(one.y1, other.y1))
    cuts = [
        (slice(y0 - b.y0, y1 - b.y0), slice(x0 - b.x0, x1 - b.x0)) for b in (one, other)
    ]
    return cuts[0], cuts[1]


def _padded(one: Instance, frame: Box) -> Instance:
    """Give a front's box a margin, inside the frame, and a probability to write on."""
    x0, y0, x1, y1 = one.box
    box = Box(
        min(x0, max(frame.x0, x0 - PAD_PX)),
        min(y0, max(frame.y0, y0 - PAD_PX)),
        max(x1, min(frame.x1, x1 + PAD_PX)),
        max(y1, min(frame.y1, y1 + PAD_PX)),
    )
    wide = np.zeros((box.y1 - box.y0, box.x1 - box.x0), np.float32)
    wide[y0 - box.y0 : y1 - box.y0, x0 - box.x0 : x1 - box.x0] = one.probability
    return replace(one, box=box, probability=wide)
