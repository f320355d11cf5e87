"""A front ends at its roof: what has no rows above it is a wall behind.

A low front before a taller building's blank wall is easily taken for one with it. Laid
straight (`laid`), the front ends where its rows end: at one row an edge runs across all
of it, below there are windows in rows and columns, above there are none, or they stand
in other columns. So each row is weighed, by what is seen along it, above and below it,
in a conditional logit (McFadden, 1974): with z = features * weights,

    probability that the front ends at row r = exp(z_r) / (1 + sum over rows of exp(z)),

where the 1 is that it ends at none. The weights are fitted to hand labels, to what cuts
gain and cost (`export/fit_roofs.py`).
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import cv2
import numpy as np
from jaxtyping import Bool, Float, Int16

from nostalgin_core.records import Box, Instance, Photo
from nostalgin_core.segment import laid
from nostalgin_core.segment.answer import Pixels
from nostalgin_core.segment.rows import Planes, features
from nostalgin_core.segment.walls import before

SHORT_PX: Final = 560  # of the copy's short side, as tax photographs have it
SMALLEST_PX: Final = 600  # of a front to be judged: below, no rows can be seen
NARROWEST_PX: Final = 16  # of its patch
WEIGHTS: Final = np.array(
    [
        -21.38,
        1.71,
        -0.64,
        0.18,
        11.1,
        -2.17,
        -19.92,
        19.69,
        -9.35,
        2.24,
        -17.83,
        -1.86,
        -0.08,
        35.51,
        10.77,
        -13.53,
        -23.62,
        21.64,
        9.99,
        -0.38,
        -15.33,
        -8.32,
        0.55,
    ]
)


def without_walls_behind(
    photo: Photo, things: Sequence[Instance], pixels: Pixels
) -> tuple[Instance, ...]:
    """Cut fronts off at their roofs where it is likelier than not that they end there.

    All that is no front stays as it is.
    """
    kept = list(things)
    for number, patch, row in roofs(photo, things, pixels):
        kept[number] = cut(things[number], patch, row)
    return tuple(kept)


def roofs(
    photo: Photo, things: Sequence[Instance], pixels: Pixels
) -> list[tuple[int, laid.Patch, int]]:
    """List the fronts that have a wall behind them: number, patch, row of the roof."""
    found = []
    for number, patch, planes in straightened(photo, things, pixels):
        told, open_to = features(planes, things[number].score)
        row = chosen(told, open_to)
        if row is not None:
            found.append((number, patch, row))
    return found


def chosen(
    told: Float[np.ndarray, "h 23"], open_to: Bool[np.ndarray, " h"]
) -> int | None:
    """Choose the likeliest row, None where none is as likely as no roof at all."""
    merit = np.where(open_to, told @ WEIGHTS, -np.inf)
    best = int(np.argmax(merit))
    return best if merit[best] > 0 else None


def cut(one: Instance, patch: laid.Patch, row: int) -> Instance:
    """Take off a front what lies above a row of its patch."""
    across = np.array([[0.0, patch.size[0]], [row - 0.5, row - 0.5], [1.0, 1.0]])
    a, b = (patch.photo_from_patch @ across).T
    line = np.cross(a / a[2], b / b[2])  # x grows along it, so below is positive
    ys = np.arange(one.box.y0, one.box.y1)[:, None]
    xs = np.arange(one.box.x0, one.box.x1)[None]
    below = line[0] * xs + line[1] * ys + line[2] > 0
    return replace(one, probability=np.where(below, one.probability, np.float32(0)))


def straightened(
    photo: Photo, things: Sequence[Instance], pixels: Pixels
) -> list[tuple[int, laid.Patch, Planes]]:
    """Lay each front straight that is large enough: its number, and what it shows.

    It is looked at on a copy of a stated size, so that a finer scan gives the same.
    """
    frame = photo.frame
    owner, free = owners(things, frame), ~before(things, frame)
    scale = min(1.0, SHORT_PX / min(owner.shape))
    size = (round(owner.shape[1] * scale), round(owner.shape[0] * scale))
    image = photo.image[frame.y0 : frame.y1, frame.x0 : frame.x1]
    light = cv2.resize(image, size, interpolation=cv2.INTER_AREA)
    light = light.astype(np.float32) / 255
    nearest = cv2.INTER_NEAREST
    owner = cv2.resize(owner, size, interpolation=nearest)
    free = cv2.resize(free.astype(np.uint8), size, interpolation=nearest) > 0
    if not ((owner >= 0) & free).any():
        return []
    seen = laid.edges(light)
    up = laid.upright(seen, (owner >= 0) & free)
    ground, front, end = (
        cv2.resize(pixels[i], size, interpolation=cv2.INTER_LINEAR) for i in (0, 1, 3)
    )
    found = []
    for number in np.unique(owner[owner >= 0]):
        whole = owner == number
        visible = whole & free
        if np.count_nonzero(visible) < SMALLEST_PX:
            continue
        patch = laid.patch(seen, whole, up, laid.level(seen, visible))
        if patch is None or min(patch.size) < NARROWEST_PX:
            continue
        masks = (one.astype(np.float32) for one in (visible, whole))
        shown = Planes(*map(patch.of, (light, *masks, end, front, ground)))
        found.append((int(number), patch.enlarged(free.shape, frame), shown))
    return found


def owners(things: Sequence[Instance], frame: Box) -> Int16[np.ndarray, "h w"]:
    """Tell whose each pixel of the frame is: a front's number, -1 where none claims it.

    It is the likelier one's: probability times score, as fronts are arranged later.
    """
    shape = (frame.y1 - frame.y0, frame.x1 - frame.x0)
    best, owner = np.zeros(shape, np.float32), np.full(shape, -1, np.int16)
    for number, one in enumerate(things):
        if one.category != "facade":
            continue
        y, x = one.box.y0 - frame.y0, one.box.x0 - frame.x0
        h, w = one.probability.shape
        here = np.s_[y : y + h, x : x + w]
        likely = one.probability * np.float32(one.score)
        more = (one.probability > 0.5) & (likely > best[here])
        best[here][more] = likely[more]
        owner[here][more] = number
    return owner
