"""Find the three square directions of a whole photo, without a mask: Manhattan's frame.

`rectify` knows which lines are on which front. Here every line is open to all three
axes; for the rest, the parts are the same, so that public benchmarks of vanishing
points (York Urban) measure what `rectify` uses.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Gray, Matrix3
from nostalgin_core.records import Box
from nostalgin_core.rectify import camera, lines, upright, vanish

FOCAL_PER_DIAGONAL = 0.85  # of the image: a compact camera's or a standard lens
FOCALS = (0.6, 0.77, 1.0, 1.3)  # over the prior's, tried for the second horizontal
TRIED = 6  # first horizontals; each start is refined before any is judged
FOCAL_SD = 0.35  # of its logarithm: any lens, not only the tax photographers'


@dataclass(frozen=True, slots=True, eq=False)
class Manhattan:
    """Three orthogonal vanishing points: up, then two horizontals; photo pixels."""

    vanishing_points: Matrix3
    focal_px: float


def find(
    image: Gray,
    *,
    frame: Box | None = None,
    focal_per_diagonal: float = FOCAL_PER_DIAGONAL,
    detect: lines.Detector = lines.detect,
) -> Manhattan | None:
    """Find three orthogonal vanishing points, or None where there are too few lines.

    For each of the best first horizontals and each of a few focal lengths, the second
    is where a right angle puts it. Every start is refined, and the one with most votes
    in the end wins.
    """
    frame = frame or Box(0, 0, image.shape[1], image.shape[0])
    strict_px, loose_px = detect(image, lines.STRICT, lines.LOOSE)
    middle = camera.centre(frame)
    prior = focal_per_diagonal * float(
        np.hypot(frame.x1 - frame.x0, frame.y1 - frame.y0)
    )
    strict = vanish.to_unit(strict_px, middle, prior)
    loose = vanish.to_unit(loose_px, middle, prior)
    length = vanish.lengths(loose_px)
    if len(loose) < 6:
        return None
    up, _ = vanish.best_vertical(strict, loose, length)
    fitted = [
        upright.fit(
            start,
            loose,
            np.ones((len(loose), 3), bool),
            np.ones(len(loose)),
            length,
            focal_sd=FOCAL_SD,
        )
        for start in _starts(up, strict, loose, length)
    ]
    if not fitted:
        return None
    world = max(fitted, key=lambda w: _votes(w.parameters, loose, length))
    points = upright.vanishing_points(world.parameters)
    return Manhattan(points @ camera.matrix(prior, frame).T, world.focal * prior)


def _starts(
    up: Float[np.ndarray, "3"],
    strict: Float[np.ndarray, "_ 4"],
    loose: Float[np.ndarray, "n 4"],
    weights: Float[np.ndarray, " n"],
) -> list[Float[np.ndarray, "5"]]:
    """List the best focal length and square horizontals for each first horizontal."""
    points, votes = vanish.horizontals(up, strict, loose, weights)
    starts = []
    for first in vanish.spread_out(points, votes, most=TRIED, apart_deg=8.0):
        trials = []
        for focal in FOCALS:
            scale = np.array([focal, focal, 1.0])
            trial = upright.start(up / scale, (first / scale)[None])
            trial = np.append(trial, trial[3] + np.pi / 2)
            trial[0] = np.log(focal)
            trials.append(trial)
        starts.append(max(trials, key=lambda t: _votes(t, loose, weights)))
    return starts


def _votes(
    parameters: Float[np.ndarray, "5"],
    loose: Float[np.ndarray, "n 4"],
    weights: Float[np.ndarray, " n"],
) -> float:
    """Weigh a whole frame: each line votes for its nearest axis, clamped at t_a."""
    near = vanish.distance_deg(upright.vanishing_points(parameters), loose).min(axis=0)
    return float(np.maximum(1 - near / vanish.ALIGNED_DEG, 0) @ weights)
