"""Instances become fronts: each pixel belongs to one, and one building is meant.

Where two fronts overlap, a pixel goes to the likelier one: the probability that it
belongs to the front, times the score, which is the probability that there is such a
front. What stands before a front is taken off its visible mask and given back in its
amodal one.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from nostalgin_core import placard
from nostalgin_core.arrays import Mask
from nostalgin_core.matte.amodal import amodal
from nostalgin_core.matte.target import Shown, corner, merits
from nostalgin_core.records import Facade, Instance, Photo, Rejection


def arrange(
    photo: Photo,
    instances: Sequence[Instance],
    *,
    least: float = 0.5,
    smallest: float = 0.004,
    swallowed: float = 0.6,
    recorded: float = 0.5,
    bend: float = 0.1,
) -> tuple[Facade, ...] | Rejection:
    """Return the fronts of a photo from left to right.

    A pixel is a front's where its probability exceeds `least` (paper, appendix). Fronts
    that keep less than the share `smallest` of the frame are dropped, and so are those
    of which a surer front covers the share `swallowed`. The front of the most merit is
    the target if its merit reaches `recorded`, or else none is; with it goes the
    neighbour towards which both roofs rise by more than `bend`, in px a px.
    """
    hidden = covered_by(instances, photo.image.shape, least=least)
    kept = _apart(
        instances,
        photo,
        hidden,
        least=least,
        smallest=smallest,
        swallowed=swallowed,
    )
    if not kept:
        return Rejection(
            photo.key,
            "segment",
            "no facade left",
            f"every front found is smaller than {smallest} of the frame or hidden by "
            "what stands before it: mask it by hand, or lower `smallest`",
        )
    kept.sort(key=lambda front: float(np.flatnonzero(front.mask.any(0)).mean()))
    shown = [Shown(f.mask, amodal(f.mask, hidden), f.score) for f in kept]
    board = placard.board(instances)
    aim = None if board is None else board.box
    pointed = None if aim is None else placard.arrow(photo, aim).x
    likely = merits(shown, photo.frame, aim, pointed)
    targets = _targets([one.mask for one in shown], likely, recorded, bend)
    beside = sorted(targets, key=lambda i: -likely[i])[1:]
    likely[beside] = np.maximum(likely[beside], BESIDE * likely.max())
    return tuple(
        _facade(i, front, float(likely[i]), target=i in targets)
        for i, front in enumerate(shown)
    )


BESIDE = 0.73  # how likely a corner is one: 8 of 11 on labelled tax photos
CRUMB = 0.1  # of the largest piece: a lamp post may cut a front in two


@dataclass(frozen=True, slots=True, eq=False)
class _Front:
    score: float
    mask: Mask


def _facade(index: int, front: Shown, merit: float, *, target: bool) -> Facade:
    return Facade(
        index=index,
        score=front.score,
        target=target,
        target_score=merit,
        mask=front.mask,
        amodal=front.whole,
        alpha=front.mask.astype(np.float32),
    )


def covered_by(
    instances: Sequence[Instance], shape: tuple[int, int], *, least: float = 0.5
) -> Mask:
    """Return the pixels of everything that is no front."""
    covered = np.zeros(shape, bool)
    for instance in instances:
        if instance.category != "facade":
            x0, y0, x1, y1 = instance.box
            covered[y0:y1, x0:x1] |= instance.probability > least
    return covered


def _apart(
    instances: Sequence[Instance],
    photo: Photo,
    hidden: Mask,
    *,
    least: float,
    smallest: float,
    swallowed: float,
) -> list[_Front]:
    """Give each pixel to one front, and drop fronts that are left with too little."""
    facades = _unswallowed(
        [i for i in instances if i.category == "facade"], least, swallowed
    )
    shape = photo.image.shape
    best = np.zeros(shape, np.float32)
    owner = np.full(shape, -1, np.int16)
    for i, facade in enumerate(facades):
        x0, y0, x1, y1 = facade.box
        likely = facade.probability * facade.score
        surer = (facade.probability > least) & (likely > best[y0:y1, x0:x1])
        best[y0:y1, x0:x1][surer] = likely[surer]
        owner[y0:y1, x0:x1][surer] = i
    x0, y0, x1, y1 = photo.frame
    enough = smallest * (x1 - x0) * (y1 - y0)
    fronts = []
    for i, facade in enumerate(facades):
        x0, y0, x1, y1 = facade.box
        mask, here = np.zeros(shape, bool), np.s_[y0:y1, x0:x1]
        mask[here] = _solid(owner[here] == i, owner[here] < 0) & ~hidden[here]
        if np.count_nonzero(mask) >= enough:
            fronts.append(_Front(facade.score, mask))
    return fronts


def _unswallowed(
    facades: Sequence[Instance], least: float, swallowed: float
) -> list[Instance]:
    """Drop fronts that lie mostly inside surer ones: the network says things twice."""
    kept: list[Instance] = []
    for facade in sorted(facades, key=lambda f: -f.score):
        inside = facade.probability > least
        total = max(1, np.count_nonzero(inside))
        if all(_shared(facade, other, least) < swallowed * total for other in kept):
            kept.append(facade)
    return kept


def _shared(one: Instance, other: Instance, least: float) -> int:
    """Return the number of pixels that both claim."""
    x0, y0 = max(one.box.x0, other.box.x0), max(one.box.y0, other.box.y0)
    x1, y1 = min(one.box.x1, other.box.x1), min(one.box.y1, other.box.y1)
    if x1 <= x0 or y1 <= y0:
        return 0
    parts = [
        i.probability[y0 - i.box.y0 : y1 - i.box.y0, x0 - i.box.x0 : x1 - i.box.x0]
        for i in (one, other)
    ]
    return int(np.count_nonzero((parts[0] > least) & (parts[1] > least)))


def _solid(mask: Mask, free: Mask) -> Mask:
    """Keep the large pieces and fill the holes in them that no other front claims."""
    pieces, labels, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8))
    if pieces < 2:
        return mask
    areas = stats[:, cv2.CC_STAT_AREA]
    areas[0] = 0
    large = (areas >= CRUMB * areas.max())[labels]
    pieces_left = large.astype(np.uint8)
    outlines, _ = cv2.findContours(
        pieces_left, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE
    )
    filled = cv2.drawContours(pieces_left, outlines, -1, 1, cv2.FILLED).astype(bool)
    return large | (filled & free)


def _targets(
    masks: Sequence[Mask], likely: np.ndarray, recorded: float, bend: float
) -> set[int]:
    """Return the front of most merit and, at a corner, the one beside it."""
    first = int(np.argmax(likely))
    if likely[first] < recorded:
        return set()
    bends = {}
    if first > 0:
        bends[first - 1] = corner(masks[first - 1], masks[first])
    if first + 1 < len(masks):
        bends[first + 1] = corner(masks[first], masks[first + 1])
    second = max(bends, key=lambda i: bends[i], default=None)
    if second is not None and bends[second] > bend:
        return {first, second}
    return {first}
