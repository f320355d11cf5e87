"""Sky that a mask took for a part of a front is taken off it.

Sky is bright, even and no thing's. What is in one piece with it and of the same tone is
sky too, wherever a mask claims it. But a wall may be as bright and even, and what lies
round it may not be sky: so a front gives up little, and only where next to nothing else
on it has that tone. Of a front that can't be told from sky by its tone,
nothing is taken.

Tones are compared on a copy of a stated size, so that a finer scan gives the same.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import cv2
import numpy as np

from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.records import Instance, Photo

SHORT_PX: Final = 560  # of the copy's short side, as tax photographs have it
WINDOW_PX: Final = 5  # over which a tone is even
EVEN: Final = 6.0  # gray levels, standard deviation in a window
BRIGHT: Final = 190.0
DEVIATIONS: Final = 2.5  # of the sky's own tone
LEAST_OFF: Final = 8.0  # gray levels that even the flattest sky may differ by
UPPER: Final = 0.7  # of the frame's height, where there may be sky
ENOUGH: Final = 0.002  # of the frame, before sky is believed
NOTABLE: Final = 0.006  # of a front: less stays for the matte to find
MOST: Final = 0.15  # of a front: more is a wall as bright as the sky
ALIKE: Final = 0.005  # of a front: beyond, other parts of it are as bright as the sky
RIM_PX: Final = 2  # between sky and wall, where a window lies over both


class Sky(NamedTuple):
    """What is sky in a frame, and all that is as bright and even."""

    seen: Mask
    alike: Mask


def without_sky(photo: Photo, things: Sequence[Instance]) -> tuple[Instance, ...]:
    """Take sky off the fronts among things, as far as tones tell it; none goes."""
    x0, y0, x1, y1 = photo.frame
    claimed = np.zeros(photo.image.shape, bool)
    for one in things:
        claimed[_cut(one)] |= one.probability > 0.5
    found = sky(photo.image[y0:y1, x0:x1], claimed[y0:y1, x0:x1])
    if found is None:
        return tuple(things)
    seen, alike = (np.zeros(photo.image.shape, bool) for _ in found)
    seen[y0:y1, x0:x1], alike[y0:y1, x0:x1] = found
    return tuple(
        _rid(one, seen[_cut(one)], alike[_cut(one)])
        if one.category == "facade"
        else one
        for one in things
    )


def sky(frame: Gray, claimed: Mask) -> Sky | None:
    """Find the sky of a frame, of which things claim some; None where none is sure."""
    scale = min(1.0, SHORT_PX / min(frame.shape))
    size = (round(frame.shape[1] * scale), round(frame.shape[0] * scale))
    tone = cv2.resize(frame, size, interpolation=cv2.INTER_AREA).astype(np.float32)
    taken = cv2.resize(claimed.astype(np.uint8), size, interpolation=cv2.INTER_AREA)
    mean = cv2.blur(tone, (WINDOW_PX, WINDOW_PX))
    spread = np.maximum(cv2.blur(tone**2, (WINDOW_PX, WINDOW_PX)) - mean**2, 0.0)
    even = spread <= EVEN**2
    even[round(UPPER * len(even)) :] = False
    free = cv2.dilate(taken, _disk(RIM_PX + 1)) == 0
    sure = _opened(even & free & (mean >= BRIGHT))
    if np.count_nonzero(sure) < ENOUGH * sure.size:
        return None
    middle = np.median(tone[sure])
    deviation = 1.4826 * np.median(np.abs(tone[sure] - middle))
    alike = even & (np.abs(mean - middle) <= max(DEVIATIONS * deviation, LEAST_OFF))
    alike = _opened(alike) | sure
    _, pieces = cv2.connectedComponents(alike.astype(np.uint8))
    seen = np.isin(pieces, np.unique(pieces[sure]))
    whole = frame.shape[::-1]
    return Sky(
        *(
            cv2.resize(one.astype(np.uint8), whole, interpolation=cv2.INTER_NEAREST) > 0
            for one in (cv2.dilate(seen.astype(np.uint8), _disk(RIM_PX)) > 0, alike)
        )
    )


def _rid(front: Instance, seen: Mask, alike: Mask) -> Instance:
    """Take sky off one front, if it may be no wall of it."""
    own = front.probability > 0.5
    whole = max(np.count_nonzero(own), 1)
    taken, left = own & seen, own & ~seen
    if not NOTABLE * whole <= np.count_nonzero(taken) <= MOST * whole:
        return front
    if np.count_nonzero(alike & left) > ALIKE * whole:
        return front
    return replace(front, probability=np.where(seen, 0, front.probability))


def _cut(one: Instance) -> tuple[slice, slice]:
    return np.s_[one.box.y0 : one.box.y1, one.box.x0 : one.box.x1]


def _opened(mask: Mask) -> Mask:
    return cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_OPEN, _disk(2)) > 0


def _disk(radius: int) -> np.ndarray:
    return cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1,) * 2)
