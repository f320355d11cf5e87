"""Where a front ends below: what hides it stands before it, and its street goes on.

The foot of a front is mostly hidden, and its amodal outline reaches halfway down what
hides it (`matte.amodal`), which is far too deep where that is near to the camera. Two
witnesses know better. A car or a person touches the ground nearer to the camera than
the front does, so that in the front's plane it does so below the front's foot; and
fronts that face one way along a street have their feet on one line.

    y(foot) - y(horizon) <= (y(touch) - y(horizon)) / BEFORE

What they leave open is not all the front's: the farther below what a camera saw the
foot is thought to be, the less of that is true.

The plane is `rectify`'s: x to the right and y down, in equal units, where what is as
high as the camera lies on a horizontal line.
"""

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
from jaxtyping import Float

from nostalgin_core import homography
from nostalgin_core.arrays import Matrix3, Points
from nostalgin_core.records import Box, Category, Facade, Occluder
from nostalgin_core.rectify import quad

# How much farther a front is from the camera than what stands before it, for all but
# the nearest quarter to it of 93 cars and 127 people on 98 labelled tax photographs.
BEFORE: Final[dict[Category, float]] = {"vehicle": 1.5, "person": 1.1}
FREE_PX: Final = 7  # below where something touches the ground, nothing else hides it
REACH: Final = 3.0  # widths of a front, to either side, within which the street is one
ALIKE_DEG: Final = 6.0  # fronts that face one way
SEEN_SHARE: Final = 0.3  # of a row, to be worth keeping whatever the witnesses say
# Of what is thought to be hidden below, and beside that of what is seen above: so far
# down labelled feet are, about.
TRUE_SHARE: Final = 0.3
USUAL_SHARE: Final = 0.05


class Touch(NamedTuple):
    """Where something that hides fronts stands on the ground, in the photo."""

    x_px: float
    y_px: float
    before: float


class Stand(NamedTuple):
    """A front in its plane, before its foot is known."""

    photo_from_plane: Matrix3
    bounds: Float[np.ndarray, "4"]  # x0, y0, x1, y1
    horizon: float  # y
    azimuth: float  # radians, modulo half a turn


def touches(occluders: Sequence[Occluder], frame: Box) -> tuple[Touch, ...]:
    """Find where people and cars stand, if nothing before them hides it."""
    if not occluders:
        return ()
    layers = np.sum([one.mask for one in occluders], axis=0)
    found = []
    for one in occluders:
        if one.category not in BEFORE or not one.mask.any():
            continue
        row = int(np.flatnonzero(one.mask.any(axis=1))[-1])
        x = int(np.flatnonzero(one.mask[row])[0])
        below = layers[row + 1 : row + 1 + FREE_PX, x]
        if row + FREE_PX < frame.y1 and not below.any():
            found.append(Touch(float(x), row + 1.0, BEFORE[one.category]))
    return tuple(found)


def feet(
    facades: Sequence[Facade],
    stands: Sequence[Stand | None],
    standing: Sequence[Touch],
) -> tuple[float | None, ...]:
    """Tell how far down each front reaches in its plane; None of those without one.

    It is the least of its own bound, what stands before it, and the median of what
    these say of the fronts beside it, and of what is hidden below the part that is
    usual; but no lower row that a camera saw is given up.
    """
    kept = [
        None if one is None else lowest_seen(facade, one)
        for facade, one in zip(facades, stands, strict=True)
    ]
    alone = [
        None
        if one is None or seen is None
        else max(min(float(one.bounds[3]), touched(one, standing)), seen)
        for one, seen in zip(stands, kept, strict=True)
    ]
    found: list[float | None] = []
    for one, own, seen in zip(stands, alone, kept, strict=True):
        if one is None or own is None or seen is None:
            found.append(None)
            continue
        every = [
            carried(one, other, foot)
            for other, foot in zip(stands, alone, strict=True)
            if other is not None and foot is not None and parallel(one, other)
        ]
        deep = max(min(own, float(np.median(every))) - seen, 0.0)
        usual = USUAL_SHARE * (seen - float(one.bounds[1])) + TRUE_SHARE * deep
        found.append(seen + min(deep, usual))
    return tuple(found)


def lowest_seen(facade: Facade, one: Stand, *, cells: int = 96) -> float:
    """Find the end of the lowest row of a front that a camera saw enough of."""
    _, y0, _, y1 = one.bounds
    grid = quad.resampled(facade.alpha, one.photo_from_plane, one.bounds, cells)
    rows = np.flatnonzero((grid > 0.5).mean(axis=1) >= SEEN_SHARE)
    last = int(rows[-1]) + 1 if len(rows) else cells
    return float(y0 + last * (y1 - y0) / cells)


def touched(one: Stand, standing: Sequence[Touch]) -> float:
    """Tell below what the foot can't be, by what stands before it; inf: by nothing."""
    x0, _, x1, _ = one.bounds
    reach = REACH * (x1 - x0)
    least = np.inf
    plane_from_photo = np.linalg.inv(one.photo_from_plane)
    for touch in standing:
        lifted = plane_from_photo @ [touch.x_px, touch.y_px, 1.0]
        if lifted[2] <= 0:
            continue
        x, y = lifted[:2] / lifted[2]
        if x0 - reach < x < x1 + reach and y > one.horizon:
            least = min(least, one.horizon + (y - one.horizon) / touch.before)
    return float(least)


def parallel(one: Stand, other: Stand) -> bool:
    """Tell whether two fronts face one way."""
    apart = (one.azimuth - other.azimuth + np.pi / 2) % np.pi - np.pi / 2
    return bool(abs(np.degrees(apart)) <= ALIKE_DEG)


def carried(one: Stand, other: Stand, foot: float) -> float:
    """Carry the foot of a front to the plane of another, at its nearer end."""
    if other is one:
        return foot
    x0, _, x1, _ = other.bounds
    ends: Points = np.array([[x0, foot], [x1, foot]])
    seen = homography.apply(other.photo_from_plane, ends)
    here = homography.apply(np.linalg.inv(one.photo_from_plane), seen)
    middle = (one.bounds[0] + one.bounds[2]) / 2
    return float(here[np.argmin(np.abs(here[:, 0] - middle)), 1])
