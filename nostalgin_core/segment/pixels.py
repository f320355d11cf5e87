"""What single pixels show mends the masks of things.

A mask comes out of one look at a box; the network's semantic branch looks at every
pixel, and knows nothing of things. Each is a witness, whose odds count to the power of
its weight, as in a logarithmic opinion pool (Genest and Zidek, "Combining Probability
Distributions", Statistical Science 1986):

    odds = mask odds ^ (1 - w) * pixel odds ^ w * prior

The weights began as a logistic regression's on block 993, which gives the same for what
hides on streets kept out of training, and there more to the pixels for fronts. What
hides is missed more often than made up, so that its prior is above 1. Where several
things claim a pixel, they share what was pooled as they shared what they had. What
pixels alone see in front of fronts becomes a thing of the class other.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

import cv2
import numpy as np
from jaxtyping import Float32

from nostalgin_core.records import Box, Instance
from nostalgin_core.segment.answer import Pixels

FRONT_WEIGHT: Final = 0.65
HIDING_WEIGHT: Final = 0.75
HIDING_PRIOR: Final = 2.0
DOUBT: Final = 0.02  # no witness is surer than this less than 1
LEAST: Final = 1e-3  # of a claim; below it, nothing is shared
SMALLEST: Final = 0.0003  # of the frame: 140 px in 560 x 840

_Plane = Float32[np.ndarray, "h w"]


def mended(
    things: Sequence[Instance],
    pixels: Pixels,
    frame: Box,
    *,
    front_weight: float = FRONT_WEIGHT,
    hiding_weight: float = HIDING_WEIGHT,
    hiding_prior: float = HIDING_PRIOR,
) -> tuple[Instance, ...]:
    """Pool masks with pixels, and add what only pixels see before fronts at the end.

    Boards keep their masks: they are planes, and pixels lose their thin frames.
    """
    front, hiding = (_spread(pixels[plane], frame) for plane in (1, 2))
    facades = [one for one in things if one.category == "facade"]
    hiders = [one for one in things if one.category not in ("facade", "placard")]
    built = pool(_highest(facades, frame), front, weight=front_weight)
    hidden = pool(
        _highest(hiders, frame), hiding, weight=hiding_weight, prior=hiding_prior
    )
    before = [one for one in things if one.category != "facade"]
    taken = _highest(before, frame) > LEAST
    walls, rest = _shared(facades, built, frame), _shared(hiders, hidden, frame)
    kept = tuple(
        one
        if one.category == "placard"
        else next(walls if one.category == "facade" else rest)
        for one in things
    )
    return kept + tuple(_others(np.where(taken, np.float32(0), hidden), frame))


def pool(mask: _Plane, pixel: _Plane, *, weight: float, prior: float = 1.0) -> _Plane:
    """Multiply two witnesses' odds, the second's to the power `weight`.

    With a prior of 1, what both say is said; nobody is surer than `DOUBT` allows.
    """
    ours, theirs = (np.clip(p, DOUBT, 1 - DOUBT) for p in (mask, pixel))
    odds = (ours / (1 - ours)) ** np.float32(1 - weight)
    odds *= (theirs / (1 - theirs)) ** np.float32(weight) * np.float32(prior)
    return (odds / (1 + odds)).astype(np.float32, copy=False)


def _shared(
    things: Sequence[Instance], pooled: _Plane, frame: Box
) -> Iterator[Instance]:
    """Give each thing the share of what was pooled that it had of the highest."""
    highest = np.maximum(_highest(things, frame), np.float32(LEAST))
    for one in things:
        x0, y0, x1, y1 = _inside(one.box, frame)
        here = np.s_[y0:y1, x0:x1]
        share = one.probability / highest[here]
        yield replace(one, probability=np.minimum(share, 1) * pooled[here])


def _others(hidden: _Plane, frame: Box) -> Iterator[Instance]:
    """Yield the connected pieces that are likelier hidden than not."""
    cells = (hidden > 0.5).astype(np.uint8)
    _, labels, stats, _ = cv2.connectedComponentsWithStats(cells)
    for i, (x, y, w, h, area) in enumerate(stats[1:], start=1):
        if area < SMALLEST * cells.size:
            continue
        here = np.s_[y : y + h, x : x + w]
        piece = labels[here] == i
        x0, y0 = frame.x0 + int(x), frame.y0 + int(y)
        box = Box(x0, y0, x0 + int(w), y0 + int(h))
        likely = np.where(piece, hidden[here], np.float32(0))
        yield Instance("other", float(hidden[here][piece].mean()), box, likely)


def _highest(things: Sequence[Instance], frame: Box) -> _Plane:
    """Lay things over one another in the frame; the highest probability counts."""
    shape = (frame.y1 - frame.y0, frame.x1 - frame.x0)
    result = np.zeros(shape, np.float32)
    for one in things:
        x0, y0, x1, y1 = _inside(one.box, frame)
        there = result[y0:y1, x0:x1]
        np.maximum(there, one.probability, out=there)
    return result


def _inside(box: Box, frame: Box) -> Box:
    """Tell where a box lies in the frame, which holds it."""
    return Box(
        box.x0 - frame.x0, box.y0 - frame.y0, box.x1 - frame.x0, box.y1 - frame.y0
    )


def _spread(plane: Float32[np.ndarray, "rows columns"], frame: Box) -> _Plane:
    """Stretch a plane over the frame, linearly."""
    size = (frame.x1 - frame.x0, frame.y1 - frame.y0)
    return cv2.resize(plane, size, interpolation=cv2.INTER_LINEAR)
