"""A view from above shows roofs and yards, and no street: its fronts are not believed.

Whoever photographs a street stands on it: the camera is a small part as high as what it
shows, and looks level or up. From a roof or from the air it is as high, and looks down.
Both speak: the height of the camera over the street, as a share of the front's
(`standpoint`), the middle one of all that the camera saw, and the tilt that all upright
lines agree on (`upright`).
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from nostalgin_core.records import Elevation, Matted, Photo, Rejection
from nostalgin_core.rectify.standpoint import standpoint
from nostalgin_core.rectify.upright import Upright

REASON: Final = "seen from above"
HIGH: Final = 0.75  # of a front's height, from which a level camera is above
PER_DEGREE: Final = 0.03  # of that, for each degree that it looks down
FEWEST: Final = 2  # fronts: one alone may be a wall, unless the camera looks down
STEEP_DEG: Final = 5.0  # by so much
SUPPORTED: Final = 10.0  # upright lines, by their weights: fewer tell no tilt

Views = Sequence[Elevation | Rejection]


def refused(
    photo: Photo, matted: Matted, views: Views, world: Upright
) -> tuple[Elevation | Rejection, ...]:
    """Reject all elevations of a photo that was taken from above; else pass them on."""
    high, down_deg = height(photo, matted, views), down(world)
    few = sum(map(bool, views)) < FEWEST and down_deg < STEEP_DEG
    if high is None or few or world.support[0] < SUPPORTED:
        return tuple(views)
    if high + PER_DEGREE * down_deg <= HIGH:
        return tuple(views)
    looks = f"{abs(down_deg):.0f} degrees {'down' if down_deg > 0 else 'up'}"
    detail = (
        f"its camera stands at {high:.0%} of the height of what it shows and looks "
        f"{looks}: use a photograph that was taken from the street, or draw its quad"
    )
    return tuple(
        Rejection(photo.key, "rectify", REASON, detail, one.facade)
        if isinstance(one, Elevation)
        else one
        for one in views
    )


def height(photo: Photo, matted: Matted, views: Views) -> float | None:
    """Give the camera's height over that of its fronts, half of what it saw above it.

    None without an elevation.
    """
    seen = {one.index: float(one.alpha.sum()) for one in matted.facades}
    told = []
    for one in views:
        if isinstance(one, Elevation):
            stood = standpoint(one, frame=photo.frame, shape=photo.image.shape)
            told.append((stood.position[1] / stood.roof, seen[one.facade]))
    if not told:
        return None
    shares, weights = np.array(sorted(told)).T
    half = np.searchsorted(weights.cumsum(), weights.sum() / 2)
    return float(shares[min(half, len(shares) - 1)])


def down(world: Upright) -> float:
    """Give by how many degrees the camera looks down; below 0 it looks up."""
    return -float(np.degrees(world.parameters[2]))
