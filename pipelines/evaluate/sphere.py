"""Refine a vanishing point on the Gaussian sphere, on the lines that vote for it.

Candidates are intersections of pairs of lines, so the best of them is as exact as two
lines are. All lines that vote for it say more, and say the same whichever of its
neighbours was the candidate: what deduplication keeps no longer matters.

Letters, as in `vanish`: `a` is a vanishing point, `d(a, s)` Rother's distance, `t_a`
the distance at which a line no longer counts. `n` is the normal of the plane through
the camera and a line.
"""

import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Lines
from nostalgin_core.rectify import vanish

ROUNDS = 30  # at most; most points stand still after five to eight
STILL_DEG = 1e-3  # a step below a hundredth of what is asked of a point
RIVALS = 6  # candidates that are refined before one is chosen
RIVALS_APART_DEG = 1.0  # nearer ones are drawn to the same point


def refined(
    point: Float[np.ndarray, "3"], lines: Lines, weights: Float[np.ndarray, " n"]
) -> Float[np.ndarray, "3"]:
    """Move a vanishing point to where the lines that vote for it meet best.

    The sine of d(a, s) is |n . a| over the lengths of the line and of the ray, so with
    the ray's length held, the sum of w sin^2 d has the least eigenvector of a 3x3
    matrix as its minimum. Here w is the line's weight times its vote 1 - d / t_a, which
    falls to nothing at t_a: no line joins or leaves with a jump, and the rounds settle.
    """
    one = np.ones((len(lines), 1))
    normals = np.cross(np.hstack([lines[:, :2], one]), np.hstack([lines[:, 2:], one]))
    middle = (lines[:, :2] + lines[:, 2:]) / 2
    length = vanish.lengths(lines)
    for _ in range(ROUNDS):
        ray = np.hypot(*(point[:2] - middle * point[2]).T)
        off = vanish.distance_deg(point[None], lines)[0]
        vote = weights * np.maximum(1 - off / vanish.ALIGNED_DEG, 0)
        n = normals / np.maximum(length * ray, 1e-12)[:, None]
        moved = np.linalg.eigh((n * vote[:, None]).T @ n)[1][:, 0]
        step = np.linalg.norm(np.cross(moved, point))
        point = moved
        if step < np.radians(STILL_DEG):
            break
    return point


def best(
    points: Float[np.ndarray, "m 3"],
    votes: Float[np.ndarray, " m"],
    lines: Lines,
    weights: Float[np.ndarray, " n"],
) -> Float[np.ndarray, "3"]:
    """Choose the point with most votes, once the best few candidates are refined.

    Two candidates may have next to the same votes and lie degrees apart. Which of them
    wins must not hang on whose exact intersection deduplication dropped.

    Raises:
        ValueError: if there is no candidate.
    """
    if not len(points):
        raise ValueError("there is no candidate to choose from")
    rivals = vanish.spread_out(points, votes, most=RIVALS, apart_deg=RIVALS_APART_DEG)
    settled = np.array([refined(one, lines, weights) for one in rivals])
    return settled[vanish.vote(settled, lines, weights).argmax()]
