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
from scipy.optimize import minimize

Numbers = Float[np.ndarray, " n"]
Unknowns = np.ndarray  # a growth and a turn for each side, in units of their spread

STRETCH_SD = 0.5  # a catalogue of photographs lists perhaps two lots in three
UNKNOWN_SD = 10.0  # of a side that nothing is known about
FREE_SD_RAD = 1.0  # of a heading in a grid that it cuts: lengths mostly decide
POLYGON_SD_RAD = 0.3  # of a heading where there are not four sides


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
    turn_sd = np.array([side.heading_sd_rad for side in sides])
    squeeze_sd = np.array([side.squeeze_sd for side in sides])
    stretch_sd = np.maximum(squeeze_sd, STRETCH_SD)
    scale = np.concatenate([stretch_sd, turn_sd])  # the unknowns are multiples of it

    def lengths(x: Unknowns) -> tuple[Numbers, Numbers]:
        growth, turn = np.split(x * scale, 2)
        return measured_m * np.exp(growth), bearing + turn

    def weights(x: Unknowns) -> Unknowns:
        squeezed = np.where(x[: len(sides)] < 0, stretch_sd / squeeze_sd, 1.0)
        return np.concatenate([squeezed, np.ones(len(sides))])

    def gap(x: Unknowns) -> Unknowns:
        length_m, heading = lengths(x)
        return length_m @ _ahead(heading) / measured_m.sum()

    def slope(x: Unknowns) -> np.ndarray:
        length_m, heading = lengths(x)
        ahead = _ahead(heading)
        aside = np.column_stack([-ahead[:, 1], ahead[:, 0]])
        by_unknown = np.concatenate([length_m[:, None] * v for v in (ahead, aside)])
        return by_unknown.T * scale / measured_m.sum()

    found = minimize(
        lambda x: float(((weights(x) * x) ** 2).sum()),
        np.zeros(2 * len(sides)),
        jac=lambda x: 2 * weights(x) ** 2 * x,
        constraints={"type": "eq", "fun": gap, "jac": slope},
        method="SLSQP",
        options={"maxiter": 200, "ftol": 1e-12},
    )
    x = found.x
    for _ in range(20):  # the last millimetres, by the shortest way
        if np.abs(gap(x)).max() < 1e-14:
            break
        x = x - np.linalg.pinv(slope(x)) @ gap(x)
    return lengths(x)


def corners(length_m: Numbers, heading_rad: Numbers) -> Float[np.ndarray, "n 2"]:
    """Walk the sides from the origin; return where each one starts."""
    steps = length_m[:, None] * _ahead(heading_rad)
    return np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)[:-1]])


def _ahead(heading_rad: Numbers) -> Float[np.ndarray, "n 2"]:
    return np.column_stack([np.cos(heading_rad), np.sin(heading_rad)])


def nominal_headings(count: int) -> Numbers:
    """Turn left by the same angle at each corner: 90 degrees where there are four."""
    return 2 * np.pi * np.arange(count) / count
