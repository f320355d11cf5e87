"""Found things are matched with labelled ones, surest first, as COCO's measure does.

A thing found is a *hit* where its mask overlaps a labelled one of its class, that no
surer thing has taken, by at least a given intersection over union. Sorted by score over
all photos, k things with h hits have precision h / k and recall h / (all labelled). The
average precision is the mean, over the 101 recalls 0, 0.01, ..., 1, of the greatest
precision reached at that recall or beyond it (Lin et al., "Microsoft COCO", 2014, and
its published evaluation).

What nobody can tell apart (COCO's crowd, our far rows) is neither hit nor miss: it asks
for nothing, and what lies on it by the share that is asked of an overlap is left out.
"""

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

from nostalgin_core.arrays import Mask

RECALLS: Final = np.linspace(0.0, 1.0, 101)


class Matches(NamedTuple):
    """What became of one class's things in one photo, or in many."""

    scores: Float[np.ndarray, " n"]
    hits: Bool[np.ndarray, " n"]
    truths: int


def matches(
    scores: Sequence[float],
    masks: Sequence[Mask],
    truths: Sequence[Mask],
    ignored: Mask,
    *,
    least: float,
) -> Matches:
    """Match what was found in one photo with what is there; leave out the ignored.

    Args:
        scores: How sure the network is of each mask.
        masks: What was found.
        truths: What is there.
        ignored: Where nobody can tell things apart.
        least: The overlap that makes a hit.
    """
    found = partners(scores, table(masks, truths), least=least)
    kept = [
        i
        for i in np.argsort(-np.asarray(scores, float), kind="stable")
        if found[i] >= 0 or covered(masks[i], ignored) < least
    ]
    return Matches(np.asarray(scores, float)[kept], found[kept] >= 0, len(truths))


def matches_of_kind(
    scores: Sequence[float],
    masks: Sequence[Mask],
    truths: Sequence[Mask],
    ignored: Mask,
    *,
    asked: Bool[np.ndarray, " m"],
    counted: Bool[np.ndarray, " n"],
    least: float,
) -> Matches:
    """Match all, but ask for some truths alone, as COCO does by area.

    What is found of the other truths is left out, and so is what is wrong, unless it
    is `counted` among the kind.
    """
    found = partners(scores, table(masks, truths), least=least)
    kept = [
        i
        for i in np.argsort(-np.asarray(scores, float), kind="stable")
        if (asked[found[i]] if found[i] >= 0 else counted[i])
        and (found[i] >= 0 or covered(masks[i], ignored) < least)
    ]
    asked_for = int(np.count_nonzero(asked))
    return Matches(np.asarray(scores, float)[kept], found[kept] >= 0, asked_for)


def partners(
    scores: Sequence[float], overlaps: Float[np.ndarray, "n m"], *, least: float
) -> Int[np.ndarray, " n"]:
    """Give each thing the free truth it overlaps most, surest first; -1 for none."""
    free = np.ones(overlaps.shape[1], bool)
    found = np.full(len(overlaps), -1)
    for i in np.argsort(-np.asarray(scores, float), kind="stable"):
        open_to = np.where(free, overlaps[i], -1.0)
        best = int(np.argmax(open_to)) if len(free) else -1
        if best >= 0 and open_to[best] >= least:
            free[best] = False
            found[i] = best
    return found


def together(parts: Sequence[Matches]) -> Matches:
    """Put the photos of a set together."""
    scores = [part.scores for part in parts] or [np.empty(0)]
    hits = [part.hits for part in parts] or [np.empty(0, bool)]
    truths = sum(part.truths for part in parts)
    return Matches(np.concatenate(scores), np.concatenate(hits), truths)


def average_precision(found: Matches) -> float:
    """Return the mean of the best precision at or beyond each recall, 0 to 1.

    It is NaN where nothing of the class is there to be found.
    """
    if not found.truths:
        return float("nan")
    order = np.argsort(-found.scores, kind="stable")
    hits = found.hits[order].cumsum()
    if not len(hits):
        return 0.0
    recall = hits / found.truths
    precision = hits / np.arange(1, len(hits) + 1)
    best_beyond = np.maximum.accumulate(precision[::-1])[::-1]
    place = np.searchsorted(recall, RECALLS, side="left")
    reached = np.append(best_beyond, 0.0)[place]
    return float(reached.mean())


def table(masks: Sequence[Mask], truths: Sequence[Mask]) -> Float[np.ndarray, "n m"]:
    """Return each mask's intersection over union with each truth."""
    if not masks or not truths:
        return np.zeros((len(masks), len(truths)))
    # Sums of ones are exact in float32 up to 2^24 pixels, and BLAS is quick at them.
    a, b = (
        np.stack([one.ravel() for one in many]).astype(np.float32)
        for many in (masks, truths)
    )
    both = (a @ b.T).astype(float)
    either = a.sum(1)[:, None] + b.sum(1)[None] - both
    return both / np.maximum(either, 1)


def covered(mask: Mask, by: Mask) -> float:
    """Return the share of a mask that lies on another; 0 of an empty one."""
    return np.count_nonzero(mask & by) / max(1, np.count_nonzero(mask))
