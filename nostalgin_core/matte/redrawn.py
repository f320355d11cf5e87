"""A front that somebody drew takes the place of what was found.

What is drawn is the outline of the whole front of the building that a photo is a record
of, cars and people before it included: its amodal mask. What hides it is taken off, and
its edge made soft, as with every other front.
"""

import inspect
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import cv2
import numpy as np

from nostalgin_core.arrays import Mask, Points
from nostalgin_core.matte import facade
from nostalgin_core.matte.matte import highest, matte, softened
from nostalgin_core.matte.straight import straight
from nostalgin_core.records import Facade, Instance, Matted, Photo, Rejection


def redrawn(
    photo: Photo, instances: Sequence[Instance], outline: Points
) -> Matted | Rejection:
    """Matte a photo whose front is known by its outline.

    The front that is most alike gives way to the drawn one, which is the photo's
    target; its neighbours give up the pixels that it takes. Where none was found it
    stands alone.
    """
    drawn = filled(outline, photo)
    if not drawn.any():
        detail = "the outline has no pixel in the exposed frame: draw it anew"
        return Rejection(photo.key, "matte", "outline beyond the frame", detail)
    straightened = straight(photo, instances)
    arranged = facade.arrange(photo, straightened)
    found = () if isinstance(arranged, Rejection) else arranged
    hidden = facade.covered_by(straightened, photo.image.shape)
    old = alike(found, drawn)
    facades = beside(found, old, drawn, hidden)
    built = [one for one in straightened if one.category == "facade"]
    likely = highest(built, photo.image.shape)
    if old is not None:
        likely[found[old].amodal & ~np.any([f.amodal for f in facades], axis=0)] = 0
    likely[drawn] = 1
    return softened(photo, straightened, facades, likely, **as_usual())


def as_usual() -> dict[str, Any]:
    """Give what `matte` does by default, which is told once, in its own signature."""
    options = inspect.signature(matte).parameters.values()
    return {one.name: one.default for one in options if one.default is not one.empty}


def filled(outline: Points, photo: Photo) -> Mask:
    """Fill an outline, inside a photo's exposed frame."""
    inside = np.zeros(photo.image.shape, np.uint8)
    cv2.fillPoly(inside, [np.rint(outline).astype(np.int32)], 1)
    framed = np.zeros(photo.image.shape, bool)
    x0, y0, x1, y1 = photo.frame
    framed[y0:y1, x0:x1] = True
    return inside.astype(bool) & framed


def alike(found: Sequence[Facade], drawn: Mask) -> int | None:
    """Tell which front shares most with a mask: both, over either; None if none does.

    Of two that share as much it is the target.
    """
    shared = [
        (np.count_nonzero(one.amodal & drawn) / np.count_nonzero(one.amodal | drawn))
        for one in found
    ]
    best = max(range(len(found)), key=lambda i: (shared[i], found[i].target), default=0)
    return best if found and shared[best] > 0 else None


def beside(
    found: Sequence[Facade], old: int | None, drawn: Mask, hidden: Mask
) -> tuple[Facade, ...]:
    """Put the drawn front among its neighbours, from left to right.

    A front of which it takes more than half is dropped.
    """
    meant = old is not None and found[old].target
    own = Facade(
        index=0,
        score=1.0,
        target=True,
        target_score=1.0,
        mask=drawn & ~hidden,
        amodal=drawn,
        alpha=(drawn & ~hidden).astype(np.float32),
    )
    kept = [own]
    for place, one in enumerate(found):
        mask = one.mask & ~drawn
        if place == old or 2 * np.count_nonzero(mask) < np.count_nonzero(one.mask):
            continue
        target = one.target and meant  # a corner that was one stays one
        left = replace(one, mask=mask, amodal=one.amodal & ~drawn, target=target)
        kept.append(left)
    kept.sort(key=lambda one: float(np.flatnonzero(one.amodal.any(0)).mean()))
    return tuple(replace(one, index=index) for index, one in enumerate(kept))
