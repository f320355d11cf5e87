"""What went wrong with each front: taken with another, cut up, missed, or a wall.

A labelled front is *found* where one front overlaps it by a half or more (intersection
over union of what is visible). Of the others,

- *missed*: less than half of its pixels are claimed by any front;
- *split*: more are, but no single front has half of them;
- *merged*: one front has, and of what that one claims besides, more lies on other
  labelled fronts than on none;
- *walled*: one front has, and took a wall, the sky or the street with it.

And a front that was found is a *wall* where less than half of it lies on any labelled
front, far rows left out.
"""

from collections.abc import Sequence
from typing import Final, Literal, NamedTuple, get_args

import numpy as np

from nostalgin_core.arrays import Mask

Fate = Literal["found", "merged", "split", "missed", "walled"]
FATES: Final[tuple[Fate, ...]] = get_args(Fate)
HALF: Final = 0.5


class Errors(NamedTuple):
    """What became of one photo's labelled fronts, and which found ones are walls."""

    fates: tuple[Fate, ...]  # one a labelled front
    holders: tuple[int, ...]  # the found front with most of it, -1 where none has any
    walls: tuple[bool, ...]  # one a found front


def errors(found: Sequence[Mask], truths: Sequence[Mask], ignored: Mask) -> Errors:
    """Name what went wrong in one photo.

    Args:
        found: What is claimed, what truly hides it taken off.
        truths: What is visible of each labelled front; none is empty.
        ignored: Where nobody can tell fronts apart.
    """
    every = np.any([np.zeros(ignored.shape, bool), *truths], axis=0)
    claimed = np.any([np.zeros(ignored.shape, bool), *found], axis=0)
    both = np.array([[np.count_nonzero(f & t) for f in found] for t in truths])
    both = both.reshape(len(truths), len(found))
    holders = tuple(int(np.argmax(row)) if row.any() else -1 for row in both)
    fates: tuple[Fate, ...] = tuple(
        _fate(t, both[i], found, claimed, every) for i, t in enumerate(truths)
    )
    return Errors(fates, holders, tuple(_wall(f, every, ignored) for f in found))


def _fate(
    truth: Mask,
    both: np.ndarray,
    found: Sequence[Mask],
    claimed: Mask,
    every: Mask,
) -> Fate:
    size = np.count_nonzero(truth)
    overlaps = [
        b / (np.count_nonzero(f) + size - b) for f, b in zip(found, both, strict=True)
    ]
    if max(overlaps, default=0.0) >= HALF:
        return "found"
    if np.count_nonzero(claimed & truth) < HALF * size:
        return "missed"
    best = int(np.argmax(both))
    if both[best] < HALF * size:
        return "split"
    besides = found[best] & ~truth
    on_others = np.count_nonzero(besides & every)
    return "merged" if 2 * on_others > np.count_nonzero(besides) else "walled"


def _wall(found: Mask, every: Mask, ignored: Mask) -> bool:
    told = found & ~ignored
    size = np.count_nonzero(told)
    if 2 * size < np.count_nonzero(found):
        return False  # most of it nobody can judge
    return bool(np.count_nonzero(told & every) < HALF * size)
