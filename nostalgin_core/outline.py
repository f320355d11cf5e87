"""The outline of a ring: its sides made to meet, as a surveyor closes a traverse.

Widths from a catalogue never add up to a closed polygon. With side lengths L_i and
headings a_i, anticlockwise, the ring closes when

    c(L, a) = sum_i L_i (cos a_i, sin a_i) = 0.

Of all closed outlines we take the one nearest to what was measured: it minimises
sum_i (ln(L_i / l_i) / s_i)^2 + ((a_i - b_i) / t_i)^2, where l_i, b_i are the measured
length and heading. The conditions are linearised and solved again until they hold
(least squares with conditions; Mikhail, Observations and Least Squares, 1976, ch. 9).
Opposite sides of a rectangle so meet at a mean weighted by their trust. Logarithms keep
every side longer than nothing.

A side may have unlisted lots, so that it stretches easily (`STRETCH_SD`); what was
measured is squeezed unwillingly.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

Numbers = Float[np.ndarray, " n"]

STRETCH_SD = 0.5  # a catalogue of photographs lists perhaps two lots in three
UNKNOWN_SD = 10.0  # of a side that nothing is known about
FREE_SD_RAD = 0.5  # of a heading that is not bound to a grid
STEP = 0.3  # of a logarithm or an angle, in one round


@dataclass(frozen=True, slots=True)
class Measured:
    """What is known of one side before the ring is closed."""

    length_m: float
    squeeze_sd: float  # relative
    heading_rad: float  # from east, anticlockwise
    heading_sd_rad: float = 0.0  # 0: fixed


def close(sides: Sequence[Measured]) -> tuple[Numbers, Numbers]:
    """Find the lengths (metres) and headings (radians) of the nearest closed outline.

    Raises:
        ValueError: if there are under three sides, or a length is not positive.
    """
    if len(sides) < 3 or min(side.length_m for side in sides) <= 0:
        raise ValueError(f"no ring closes over {[side.length_m for side in sides]}")
    measured_m = np.array([side.length_m for side in sides])
    bearing = np.array([side.heading_rad for side in sides])
    heading_variance = np.array([side.heading_sd_rad**2 for side in sides])
    squeeze = np.array([side.squeeze_sd for side in sides])
    growth, turn = np.zeros(len(sides)), np.zeros(len(sides))
    for _ in range(200):
        length_sd = np.where(growth >= 0, np.maximum(squeeze, STRETCH_SD), squeeze)
        variance = np.concatenate([length_sd**2, heading_variance])
        length_m = measured_m * np.exp(growth)
        ahead = np.column_stack([np.cos(bearing + turn), np.sin(bearing + turn)])
        aside = np.column_stack([-ahead[:, 1], ahead[:, 0]])
        slope = (
            length_m[:, None] * np.vstack([ahead, aside]).reshape(2, -1, 2)
        ).reshape(-1, 2)  # of the two conditions, by each unknown
        gap = length_m @ ahead
        now = np.concatenate([growth, turn])
        normal = slope.T @ (variance[:, None] * slope)
        pull = np.linalg.lstsq(normal, now @ slope - gap, rcond=1e-12)[0]
        step = np.clip(variance * (slope @ pull) - now, -STEP, STEP)
        growth, turn = np.split(now + step, 2)
        if np.abs(step).max() < 1e-13:
            break
    return measured_m * np.exp(growth), bearing + turn


def corners(length_m: Numbers, heading_rad: Numbers) -> Float[np.ndarray, "n 2"]:
    """Walk the sides from the origin; return where each one starts."""
    steps = length_m[:, None] * np.column_stack(
        [np.cos(heading_rad), np.sin(heading_rad)]
    )
    return np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)[:-1]])


def nominal_headings(count: int) -> Numbers:
    """Turn left by the same angle at each corner: 90 degrees where there are four."""
    return 2 * np.pi * np.arange(count) / count
