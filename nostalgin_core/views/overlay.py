"""How one elevation lies over another of the same front: shift and scale, then more.

Both are seen straight on, so that one is the other's, shifted and stretched along two
axes; windows repeat, so that most matches are of other windows. Each match proposes a
shift and scale; what most others agree with is fitted (least squares), and where enough
do, loosened to an affinity (RANSAC) for what straightening got wrong.
"""

from dataclasses import dataclass
from typing import Final, NamedTuple

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32

from nostalgin_core.arrays import Matrix3
from nostalgin_core.views.marks import Marks

ALIKE: Final = 3  # of each mark, those most like it, either way
PROPOSED: Final = 250  # by the matches most alike
FITTED: Final = 20
NEAR: Final = 0.012  # of the longer side
SIZES: Final = 0.5  # logarithm of sizes, between a match and what it agrees with
STRETCHED: Final = 0.5  # logarithm, one axis against the other
SCALES: Final = (0.2, 5.0)
FEWEST: Final = 4
FEWEST_LOOSE: Final = 8
KEPT: Final = 0.6  # of those that agreed, by what is loosened
UNLIKE: Final = 0.3  # squared distance of looks at which a match weighs 1 / e
ROUNDS: Final = 4

Axes = tuple[float, float, float, float]  # scale and shift along x, then along y


@dataclass(frozen=True, slots=True, eq=False)
class Overlay:
    """Where the texels of one elevation lie in the other."""

    matrix: Matrix3  # second from first, texels
    support: float  # weight of the matches that agree


class Matches(NamedTuple):
    """Marks of one elevation that are like marks of the other."""

    a: Float32[np.ndarray, "n 2"]
    b: Float32[np.ndarray, "n 2"]
    growth: Float32[np.ndarray, " n"]  # logarithm of sizes, second over first
    weight: Float32[np.ndarray, " n"]
    near_px: float


def overlay(first: Marks, second: Marks) -> Overlay | None:
    """Lay the first elevation over the second; None if nothing fits."""
    some = matches(first, second)
    best: tuple[float, Axes, Bool[np.ndarray, " n"]] | None = None
    for agreeing in proposals(some):
        found = fitted(some, agreeing)
        if found is None:
            continue
        support = float(some.weight[found[1]].sum())
        if best is None or support > best[0]:
            best = (support, *found)
    if best is None:
        return None
    return Overlay(loosened(some, best[1], best[2]), best[0])


def matches(first: Marks, second: Marks) -> Matches:
    """Pair marks each of which is among the other's most alike."""
    like = first.looks @ second.looks.T
    mutual = np.zeros(like.shape, bool)
    if min(like.shape) > 0:
        mutual = among_most(like) & among_most(np.ascontiguousarray(like.T)).T
    i, j = np.nonzero(mutual)
    apart = 2 - 2 * like[i, j]
    return Matches(
        first.at_px[i],
        second.at_px[j],
        np.log(second.size_px[j] / first.size_px[i]),
        np.exp(-apart / UNLIKE),
        NEAR * max(second.shape),
    )


def among_most(like: Float32[np.ndarray, "n m"]) -> Bool[np.ndarray, "n m"]:
    """Tell of each row which of its entries are the largest."""
    left = np.array(like)
    kept = np.zeros(like.shape, bool)
    rows = np.arange(len(like))
    for _ in range(min(ALIKE, like.shape[1])):
        most = left.argmax(axis=1)
        kept[rows, most] = True
        left[rows, most] = -np.inf
    return kept


def proposals(some: Matches) -> list[Bool[np.ndarray, " n"]]:
    """Tell who agrees with the shift and scale of a match, most weight first."""
    asked = np.argsort(-some.weight, kind="stable")[:PROPOSED]
    scale = np.exp(some.growth[asked])[:, None, None]
    lies = some.b[asked][:, None] + scale * (some.a[None] - some.a[asked][:, None])
    x, y = np.moveaxis(lies - some.b[None], 2, 0)
    grows = np.abs(some.growth[None] - some.growth[asked][:, None])
    agree = (x * x + y * y < (3 * some.near_px) ** 2) & (grows < SIZES)
    order = np.argsort(-(agree * some.weight).sum(axis=1), kind="stable")
    return [agree[one] for one in order[:FITTED] if agree[one].sum() >= FEWEST]


def fitted(
    some: Matches, agreeing: Bool[np.ndarray, " n"]
) -> tuple[Axes, Bool[np.ndarray, " n"]] | None:
    """Fit scale and shift along both axes to matches, and gather who agrees."""
    axes = (1.0, 0.0, 1.0, 0.0)
    for _ in range(ROUNDS):
        axes = (
            *line(some.a[agreeing, 0], some.b[agreeing, 0]),
            *line(some.a[agreeing, 1], some.b[agreeing, 1]),
        )
        if not all(SCALES[0] < scale < SCALES[1] for scale in axes[::2]):
            return None
        off = np.linalg.norm(laid(some.a, axes) - some.b, axis=1)
        grows = np.abs(some.growth - np.log(axes[0] * axes[2]) / 2)
        agreeing = (off < some.near_px) & (grows < SIZES)
        if len(np.unique(some.a[agreeing], axis=0)) < FEWEST:
            return None
    if abs(np.log(axes[0] / axes[2])) > STRETCHED:
        return None
    return axes, agreeing


def line(
    a: Float32[np.ndarray, " n"], b: Float32[np.ndarray, " n"]
) -> tuple[float, float]:
    """Fit scale and shift along one axis (least squares); scale 0: nothing tells."""
    centred = a - a.mean()
    spread = float(centred @ centred)
    scale = float(centred @ (b - b.mean())) / spread if spread > 0 else 0.0
    return scale, float(b.mean()) - scale * float(a.mean())


def laid(points: Float32[np.ndarray, "n 2"], axes: Axes) -> Float[np.ndarray, "n 2"]:
    """Scale and shift points along both axes."""
    return points * np.array(axes[::2]) + np.array(axes[1::2])


def loosened(some: Matches, axes: Axes, agreeing: Bool[np.ndarray, " n"]) -> Matrix3:
    """Give the matrix of two axes, or of the affinity that enough near matches fit."""
    strict = np.array([[axes[0], 0, axes[1]], [0, axes[2], axes[3]], [0, 0, 1.0]])
    near = np.linalg.norm(laid(some.a, axes) - some.b, axis=1) < 2.5 * some.near_px
    if near.sum() < FEWEST_LOOSE:
        return strict
    loose, kept = cv2.estimateAffine2D(
        some.a[near], some.b[near], ransacReprojThreshold=0.6 * some.near_px
    )
    if loose is None or kept.sum() < max(FEWEST_LOOSE, KEPT * agreeing.sum()):
        return strict
    return np.vstack([loose, [0, 0, 1]])
