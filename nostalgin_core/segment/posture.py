"""A photograph that lies on its side, on its head, or is a negative, is told so.

Cheap cues come first: how light and how busy a street is from its top to its foot (sky,
fronts, street), whether thin level or upright lines prevail, and whether its darks or
its lights reach further. A conditional logit (McFadden, 1974) weighs them for the
photograph as it is and in each posture it may have been meant in:

    p(posture) = exp(w . cues(posture)) / sum over postures of exp(w . cues)

The weights are fitted to upright photographs (`export/fit_posture.py`). Cues alone
take one upright photograph in five for something else. So where they give the
photograph as it is less than `DOUBT`, the network is shown the likeliest others
(`segment`). Where it is the surer of one of them, that speaks for it: logarithms of
odds are added.
"""

from typing import Final, NamedTuple

import cv2
import numpy as np
from jaxtyping import Float, Float32, UInt8

from nostalgin_core.arrays import Gray
from nostalgin_core.segment.answer import Pixels

DOUBT: Final = 0.2  # below it, one upright photograph in nine is looked at again
LOOKS: Final = 2  # at other postures, the likeliest first
SURE: Final = 0.9  # of what a pixel is
KNOWING: Final = 10.0  # what a network that is e times as sure adds to log odds
LEAST: Final = 0.01  # what a network is sure of that is sure of nothing
ENOUGH: Final = 5.5  # log odds of a photograph that is refused; streets came to 5.2
ENOUGH_NEGATIVE: Final = 3.5  # the network knows negatives nearly as well
RIM: Final = 0.04  # of the shorter side, where prints keep their margins
SIDE_PX: Final = 96
LINES_PX: Final = 320
BANDS: Final = 8
BUSY: Final = 70  # percentile of gradients from which lines are counted

_LIGHT: Final = (0, 2, 5, 7)  # bands, from the top, whose tone counts
_LIVELY: Final = (0, 2, 5, 7)  # and whose details
WEIGHTS: Final = np.array(
    [2.15, 0.83, -0.92, 0.96, -1.51, -0.28, 2.21, -1.53, -0.14, 0.82, -0.56, 0.94, 0.76]
)
"""For the bands' tone, for their details, for upright lines, skew, darks, lights."""


class Doubt(NamedTuple):
    """What cues alone make of a posture beside the one a photograph has."""

    posture: "Posture"
    log_odds: float


class Posture(NamedTuple):
    """What undoes a posture, and what is said of a photograph that is in it."""

    quarters: int  # to turn to the left by
    reason: str
    remedy: str
    negative: bool = False


POSTURES: Final = (
    Posture(0, "upright", ""),
    Posture(1, "turned by 90 degrees", "turn it by 90 degrees to the left"),
    Posture(2, "upside down", "turn it by 180 degrees"),
    Posture(3, "turned by 90 degrees", "turn it by 90 degrees to the right"),
    Posture(0, "a negative", "invert its tones", negative=True),
)


def doubted(frame: Gray) -> tuple[Doubt, ...]:
    """Return the postures that a photograph may be in, unless it is likely upright."""
    told = cues(frame) @ WEIGHTS
    likely = np.exp(told - told.max())
    likely /= likely.sum()
    if likely[0] >= DOUBT:
        return ()
    order = np.argsort(-likely[1:], kind="stable")[:LOOKS] + 1
    return tuple(Doubt(POSTURES[i], float(told[i] - told[0])) for i in order)


def undone(frame: Gray, posture: Posture) -> UInt8[np.ndarray, "rows columns"]:
    """Turn a photograph upright, or make a negative a positive."""
    turned = np.rot90(frame, posture.quarters)
    return np.ascontiguousarray(255 - turned if posture.negative else turned)


def excess(doubt: Doubt, other: float, this: float) -> float:
    """Return by how much what speaks for a posture exceeds what refuses a photograph.

    It is never above 0 where the network is no surer of the posture undone.

    Args:
        doubt: What cues say.
        other: How sure the network is where the posture is undone (`sure`).
        this: How sure it is of the photograph as it is.
    """
    if other <= this:
        return -np.inf
    enough = ENOUGH_NEGATIVE if doubt.posture.negative else ENOUGH
    return float(doubt.log_odds + KNOWING * np.log(other / max(this, LEAST)) - enough)


def sure(pixels: Pixels) -> float:
    """Return the share of pixels that surely are ground, front or what hides it."""
    return float((pixels[:3].max(0) > SURE).mean())


def cues(frame: Gray) -> Float[np.ndarray, "5 13"]:
    """Return what is weighed, for each of `POSTURES`."""
    rim = round(RIM * min(frame.shape))
    inner = frame[rim : frame.shape[0] - rim, rim : frame.shape[1] - rim]
    small = cv2.resize(inner, (SIDE_PX, SIDE_PX), interpolation=cv2.INTER_AREA)
    upright = _upright_lines(inner)
    rows = []
    for posture in POSTURES:
        shown = undone(small, posture).astype(np.float32)
        lines = upright if posture.quarters % 2 == 0 else -upright
        rows.append(np.concatenate([_bands(shown), lines, _tones(shown)]))
    return np.array(rows)


def _bands(shown: Float32[np.ndarray, "s s"]) -> Float[np.ndarray, " 8"]:
    """Return how light some bands are, and how full of details, from the top."""
    across, down = np.abs(np.diff(shown, axis=1)), np.abs(np.diff(shown, axis=0))
    lively = np.log(across[:-1] + down[:, :-1] + 2)
    tone = (shown - shown.mean()) / (shown.std() + 1e-6)
    parts = []
    for plane, kept in ((tone, _LIGHT), (lively - lively.mean(), _LIVELY)):
        means = [band.mean() for band in np.array_split(plane, BANDS)]
        parts += [means[i] for i in kept]
    return np.array(parts)


def _tones(shown: Float32[np.ndarray, "s s"]) -> Float[np.ndarray, " 3"]:
    """Return the skew of the tones, and how far darks and lights reach."""
    tone = (shown - shown.mean()) / (shown.std() + 1e-6)
    return np.array([(tone**3).mean(), *np.percentile(tone, (2, 98))])


def _upright_lines(inner: Gray) -> Float[np.ndarray, " 2"]:
    """Return how much more upright than level lines weigh, within 1 and 6 degrees."""
    scale = LINES_PX / max(inner.shape)
    size = [max(8, round(side * scale)) for side in inner.shape[::-1]]
    small = cv2.resize(inner, size, interpolation=cv2.INTER_AREA).astype(np.float32)
    smooth = cv2.GaussianBlur(small, (0, 0), 1)
    across = cv2.Sobel(smooth, cv2.CV_32F, 1, 0)
    down = cv2.Sobel(smooth, cv2.CV_32F, 0, 1)
    weight = np.hypot(across, down)
    weight *= weight > np.percentile(weight, BUSY)
    angles = np.rad2deg(np.arctan2(down, across)) % 180
    share, _ = np.histogram(angles, bins=180, range=(0, 180), weights=weight)
    share = share / max(float(share.sum()), 1e-6)

    def within(middle: int, reach: int) -> float:
        near = (np.arange(-reach, reach + 1) + middle) % 180
        return float(np.log(share[near].sum() + 1e-3))

    return np.array([within(0, r) - within(90, r) for r in (1, 6)])
