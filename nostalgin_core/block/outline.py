"""The outline of a ring: its sides made to meet, as a surveyor closes a traverse.

Widths from a catalogue never add up to a closed polygon. With side lengths L_i and
headings a_i, anticlockwise, the ring closes when

    c(L, a) = sum_i L_i (cos a_i, sin a_i) = 0.

Of all closed outlines we take the one nearest to what was measured: it minimises
sum_i (ln(L_i / l_i) / s_i)^2 + ((a_i - b_i) / t_i)^2, where l_i, b_i are the measured
length and heading. The conditions are linearised and solved again until they hold
(least squares with conditions; Mikhail, Observations and Least Squares, 1976, ch. 9).
The search ends micrometres away from the minimum, and where exactly hangs on the last
bits of its sums; so Newton's steps on the Lagrangian finish it, and what is left of
rounding is rounded off: the same widths give the same bytes on any machine.
Opposite sides of a rectangle so meet at a mean weighted by their trust. Logarithms keep
every side longer than nothing.

A side may have unlisted lots, so that it stretches easily (`STRETCH_SD`); what was
measured is squeezed unwillingly.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from jaxtyping import Float

Numbers = Float[np.ndarray, " n"]
Unknowns = np.ndarray  # a growth and a turn for each side, in units of their spread

STRETCH_SD = 0.5  # a catalogue of photographs lists perhaps two lots in three
UNKNOWN_SD = 10.0  # of a side that nothing is known about
FREE_SD_RAD = 1.0  # of a heading in a grid that it cuts: lengths mostly decide
POLYGON_SD_RAD = 0.3  # of a heading where there are not four sides
NEAR = 1e-2  # spreads: a search that ends further from the minimum has failed
DIGITS = 9  # of metres and radians; rounding errors lie three digits below


@dataclass(frozen=True, slots=True)
class Measured:
    """What is known of one side before the ring is closed."""

    length_m: float
    squeeze_sd: float  # relative
    heading_rad: float  # from east, anticlockwise
    heading_sd_rad: float = 0.0  # 0: fixed
    stretch_sd: float | None = None  # relative; None: `STRETCH_SD`, at least squeeze_sd


@dataclass(frozen=True, slots=True, eq=False)
class _Traverse:
    """The sides as they were measured; unknowns are multiples of their spread."""

    measured_m: Numbers
    bearing: Numbers
    scale: Unknowns  # how far a unit stretches (as a logarithm) and turns a side
    squeeze: Numbers  # the weight of a side that is shortened; a stretch weighs 1

    def lengths(self, x: Unknowns) -> tuple[Numbers, Numbers]:
        growth, turn = np.split(x * self.scale, 2)
        return self.measured_m * np.exp(growth), self.bearing + turn

    def weights(self, x: Unknowns) -> Unknowns:
        squeezed = np.where(x[: len(self.squeeze)] < 0, self.squeeze, 1.0)
        return np.concatenate([squeezed, np.ones(len(self.squeeze))])

    def gap(self, x: Unknowns) -> Unknowns:
        length_m, heading = self.lengths(x)
        return length_m @ _ahead(heading) / self.measured_m.sum()

    def slope(self, x: Unknowns) -> np.ndarray:
        along, across = self._steps(x)
        return np.concatenate([along, across]).T * self.scale

    def curvature(self, x: Unknowns, pull: Unknowns) -> np.ndarray:
        """Differentiate pull . gap twice: a side's growth and turn bend each other."""
        along, across = (np.diag(steps @ pull) for steps in self._steps(x))
        return np.block([[along, across], [across, -along]]) * np.outer(
            self.scale, self.scale
        )

    def _steps(self, x: Unknowns) -> tuple[np.ndarray, np.ndarray]:
        """Give each side's way in shares of the whole, and the same turned left."""
        length_m, heading = self.lengths(x)
        along = length_m[:, None] * _ahead(heading) / self.measured_m.sum()
        return along, np.column_stack([-along[:, 1], along[:, 0]])


def close(sides: Sequence[Measured]) -> tuple[Numbers, Numbers]:
    """Find the lengths (metres) and headings (radians) of the nearest closed outline.

    Raises:
        ValueError: if there are under three sides, or a length is not positive.
    """
    if len(sides) < 3 or min(side.length_m for side in sides) <= 0:
        raise ValueError(f"no ring closes over {[side.length_m for side in sides]}")
    squeeze_sd = np.array([side.squeeze_sd for side in sides])
    stretch_sd = np.array(
        [
            max(side.squeeze_sd, STRETCH_SD)
            if side.stretch_sd is None
            else max(side.squeeze_sd, side.stretch_sd)
            for side in sides
        ]
    )
    turn_sd = np.array([side.heading_sd_rad for side in sides])
    traverse = _Traverse(
        measured_m=np.array([side.length_m for side in sides]),
        bearing=np.array([side.heading_rad for side in sides]),
        scale=np.concatenate([stretch_sd, turn_sd]),
        squeeze=stretch_sd / squeeze_sd,
    )
    found = scipy.optimize.minimize(  # which SciPy loads when it is first asked for
        lambda x: float(((traverse.weights(x) * x) ** 2).sum()),
        np.zeros(2 * len(sides)),
        jac=lambda x: 2 * traverse.weights(x) ** 2 * x,
        constraints={"type": "eq", "fun": traverse.gap, "jac": traverse.slope},
        method="SLSQP",
        options={"maxiter": 200, "ftol": 1e-12},
    )
    x = _closed(traverse, _finished(traverse, found.x))
    length_m, heading = traverse.lengths(x)
    return np.round(length_m, DIGITS), np.round(heading, DIGITS)


def closure(sides: Sequence[Measured]) -> float:
    """Tell by how many metres a walk along the sides as measured misses its start."""
    length_m = np.array([side.length_m for side in sides])
    heading = np.array([side.heading_rad for side in sides])
    return float(np.hypot(*(length_m[:, None] * _ahead(heading)).sum(0)))


def _finished(traverse: _Traverse, x: Unknowns) -> Unknowns:
    """Go the rest of the way to the minimum by Newton's steps on the Lagrangian.

    A step that grows is not taken: the search ended too far away, or at a bend.
    """
    reach = NEAR
    for _ in range(10):
        weight, slope = traverse.weights(x) ** 2, traverse.slope(x)
        pull = np.linalg.lstsq(slope.T, weight * x, rcond=None)[0]
        bend = np.diag(weight) - traverse.curvature(x, pull)
        system = np.block([[bend, -slope.T], [slope, np.zeros((2, 2))]])
        wanted = np.concatenate([slope.T @ pull - weight * x, -traverse.gap(x)])
        step = np.linalg.lstsq(system, wanted, rcond=None)[0][: len(x)]
        if not np.abs(step).max() < reach:
            break
        x, reach = x + step, float(np.abs(step).max())
    return x


def _closed(traverse: _Traverse, x: Unknowns) -> Unknowns:
    """Go the last millimetres home by the shortest way."""
    for _ in range(20):
        if np.abs(traverse.gap(x)).max() < 1e-14:
            break
        x = x - np.linalg.pinv(traverse.slope(x)) @ traverse.gap(x)
    return x


def corners(length_m: Numbers, heading_rad: Numbers) -> Float[np.ndarray, "n 2"]:
    """Walk the sides from the origin; return where each one starts."""
    steps = length_m[:, None] * _ahead(heading_rad)
    return np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)[:-1]])


def _ahead(heading_rad: Numbers) -> Float[np.ndarray, "n 2"]:
    return np.column_stack([np.cos(heading_rad), np.sin(heading_rad)])


def nominal_headings(count: int) -> Numbers:
    """Turn left by the same angle at each corner: 90 degrees where there are four."""
    return 2 * np.pi * np.arange(count) / count
