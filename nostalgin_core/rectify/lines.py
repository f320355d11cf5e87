"""Find the straight pieces of an image's contours, to a fraction of a pixel.

Edges are linked into contours, every contour point is called linear or not by how fast
the contour turns on either side of it, and a line is fitted to each run of linear
points. What bends (trees, people, ornament) leaves no line, which is the point.

Letters, as in the paper (section 3.3.1 and the appendix): `alpha` is the direction of
the contour at a point, `L` and `R` are the mean turn between a point and the `k_s`
points before and after it, `t_alpha` the turn from which a point is not linear.
"""

from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Bool, Float, Int

from nostalgin_core.arrays import Gray, Lines, Mask, Points
from nostalgin_core.rectify import contours as edge_contours
from nostalgin_core.rectify.contours import Contours

CHORD_PX = 4  # contour points on either side that give the direction at a point
STRICT = (16, 4.0)  # k_s, t_alpha in degrees: where candidates are accumulated
LOOSE = (8, 9.0)  # and where lines vote
STRAY_PX = 1.2  # a run that leaves its line by more is cut there
CUTS = 4  # rounds of cutting; each can halve what is left
TUKEY_PX = 1.5  # beyond it a point has next to no say in its line
SHORTEST_PX = 8.0  # shorter lines say nothing about direction
ROUGHEST_PX = 0.6  # the root mean square distance of a line's points


def directions(contours: Contours) -> Float[np.ndarray, " n"]:
    """Measure alpha, the contour's direction at each point, in degrees modulo 180.

    A chord to `CHORD_PX` points on either side is used (fewer at a contour's ends):
    the direction between neighbouring pixels knows only steps of 45 degrees.
    """
    n = len(contours.points)
    start, stop = _extent(contours.contour)
    here = np.arange(n)
    chord = (
        contours.points[np.minimum(here + CHORD_PX, stop - 1)]
        - contours.points[np.maximum(here - CHORD_PX, start)]
    )
    return np.degrees(np.arctan2(chord[:, 1], chord[:, 0])) % 180


def _extent(
    contour: Int[np.ndarray, " n"],
) -> tuple[Int[np.ndarray, " n"], Int[np.ndarray, " n"]]:
    """Give each point the first index of its contour, and one past the last."""
    if not len(contour):
        return np.empty(0, np.intp), np.empty(0, np.intp)
    change = np.flatnonzero(np.diff(contour, prepend=contour[0] - 1))
    bound = np.append(change, len(contour))
    run = np.cumsum(np.diff(contour, prepend=contour[0]) != 0)
    return bound[run], bound[run + 1]


def turns(
    contours: Contours, alpha: Float[np.ndarray, " n"], k_s: int
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    """Measure L and R, the mean turn to the `k_s` points before and after, in degrees.

    Near a contour's end the mean is over the points that there are (section 3.3.1,
    equations 3 and 4; they leave the ends open).
    """
    n = len(alpha)
    left, right = np.zeros(n), np.zeros(n)
    before, after = np.zeros(n), np.zeros(n)
    for d in range(1, min(k_s, n - 1) + 1):
        turn = np.abs(alpha[d:] - alpha[:-d])
        turn = np.minimum(turn, 180 - turn)
        same = contours.contour[d:] == contours.contour[:-d]
        turn = np.where(same, turn, 0.0)
        left[d:] += turn
        before[d:] += same
        right[:-d] += turn
        after[:-d] += same
    return left / np.maximum(before, 1), right / np.maximum(after, 1)


def linear(contours: Contours, k_s: int, t_alpha: float) -> Bool[np.ndarray, " n"]:
    """Tell which contour points are locally linear (appendix, algorithm 1, mended).

    The printed algorithm walks a state `oncurve` along the contour: a point whose
    right side is straight ends a curve, one whose left side bends starts one. Changed:

    - the first loop assigns `not oncurve and R < t`, which flips at every step on a
      straight start; meant is its mirror image of the last loop, walking outwards and
      staying on the curve once `R >= t`;
    - the state is set to True between the loops and to False before the last, which
      throws away what was learnt: here the middle starts from the first point's own
      right side, and the last loop goes on from the middle's state;
    - loops shorter than the contour's ends overlap where it has fewer than 2 k_s
      points: there the middle is empty, and a point is linear if both sides are.

    The state has memory, but only of its last change, so a running maximum over the
    positions of changes computes it for all contours at once.
    """
    alpha = directions(contours)
    left, right = turns(contours, alpha, k_s)
    n = len(alpha)
    start, stop = _extent(contours.contour)
    here = np.arange(n)
    middle = (here >= start + k_s) & (here < stop - k_s)
    curve_starts = left >= t_alpha
    curve_ends = (right < t_alpha) & ~curve_starts
    decided = np.where(curve_starts | curve_ends | (here == start), here, -1)
    last = np.maximum.accumulate(decided)
    on_curve = ~curve_ends[last]
    both = (left < t_alpha) & (right < t_alpha)
    short = stop - start < 2 * k_s
    straight = middle & ~on_curve
    head = (here < start + k_s) & ~short
    tail = (here >= stop - k_s) & ~short
    # Outwards from the middle, one bend puts all that follows on the curve.
    bends_head = np.cumsum((head & (right >= t_alpha)).astype(np.intp))
    total_at = np.minimum(start + k_s, n) - 1
    straight |= head & (bends_head[total_at] - bends_head + (right >= t_alpha) == 0)
    bends_tail = np.cumsum((tail & (left >= t_alpha)).astype(np.intp))
    entered = np.maximum(stop - k_s, 1) - 1  # the last point of the middle
    straight |= tail & ~on_curve[entered] & (bends_tail == bends_tail[entered])
    return straight | (short & both)


def fit(contours: Contours, straight: Bool[np.ndarray, " p"]) -> Lines:
    """Fit a line to each run of linear points, robustly, with ends between pixels.

    The paper uses RANSAC. Points of one run are already nearly in line, so total least
    squares with Tukey's weights converges from plain total least squares, needs no
    random numbers and fits all runs at once. A run that strays from its line by more
    than `STRAY_PX` is cut where it strays most, and its parts are fitted again. The
    line's ends are the run's ends, carried onto the line.
    """
    points = contours.points[straight]
    index = np.flatnonzero(straight)
    if not len(index):
        return np.empty((0, 4))
    contour = contours.contour[straight]
    breaks = (np.diff(index, prepend=index[0] - 2) > 1) | (
        np.diff(contour, prepend=contour[0] - 1) > 0
    )
    for _ in range(CUTS):
        run = np.cumsum(breaks) - 1
        _, _, stray = _fit_runs(points, run, rounds=1)
        far = np.abs(stray)
        first = np.flatnonzero(breaks)
        worst = np.maximum.reduceat(far, first)
        at = np.flatnonzero((far >= worst[run]) & (far > STRAY_PX))
        at = at[~breaks[at]]
        if not len(at):
            break
        breaks[at] = True
    run = np.cumsum(breaks) - 1
    centre, along, stray = _fit_runs(points, run)
    first = np.flatnonzero(breaks)
    last = np.append(first[1:], len(points)) - 1
    rms = np.sqrt(np.add.reduceat(stray**2, first) / (last - first + 1))
    reach = np.stack([points[first], points[last]], axis=1) - centre[:, None]
    reach = np.einsum("rek,rk->re", reach, along)
    ends = centre[:, None] + reach[..., None] * along[:, None]
    lines = ends.reshape(-1, 4)
    length = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    return lines[(length >= SHORTEST_PX) & (rms <= ROUGHEST_PX)]


def _fit_runs(
    points: Points, run: Int[np.ndarray, " n"], *, rounds: int = 4
) -> tuple[Float[np.ndarray, "r 2"], Float[np.ndarray, "r 2"], Float[np.ndarray, " n"]]:
    """Fit all runs: a point on each line, its direction, each point's distance."""
    first = np.flatnonzero(np.diff(run, prepend=-1))
    weight = np.ones(len(points))
    x, y = points.T
    for _ in range(rounds):
        total = np.add.reduceat(weight, first)
        middle_x = np.add.reduceat(x * weight, first) / total
        middle_y = np.add.reduceat(y * weight, first) / total
        dx, dy = x - middle_x[run], y - middle_y[run]
        wx, wy = weight * dx, weight * dy
        xx, yy = np.add.reduceat(wx * dx, first), np.add.reduceat(wy * dy, first)
        angle = 0.5 * np.arctan2(2 * np.add.reduceat(wx * dy, first), xx - yy)
        cosine, sine = np.cos(angle), np.sin(angle)
        stray = dy * cosine[run] - dx * sine[run]
        weight = np.maximum(1 - (stray / TUKEY_PX) ** 2, 1e-3) ** 2
    centre = np.column_stack([middle_x, middle_y])
    return centre, np.column_stack([cosine, sine]), stray


@runtime_checkable
class Detector(Protocol):
    """Finds the lines of an image, once for each pair of settings."""

    def __call__(
        self, image: Gray, /, *settings: tuple[int, float], where: Mask | None = None
    ) -> tuple[Float[np.ndarray, "_ 4"], ...]:
        """Find lines; a detector without such settings returns the same for each.

        Edges outside `where` need not be followed.
        """
        ...


def detect(
    image: Gray,
    /,
    *settings: tuple[int, float],
    where: Mask | None = None,
    spread: float = edge_contours.MEDIAN_SPREAD,
) -> tuple[Float[np.ndarray, "_ 4"], ...]:
    """Find the lines of an image once for each pair of `k_s` and `t_alpha` in degrees.

    The contours are shared, since only the label of linear points depends on the pair.
    Only edges inside `where` are followed.
    """
    image = edge_contours.even_out(image)
    low, high = edge_contours.canny_thresholds(image, spread=spread)
    mask, points = edge_contours.edges(image, low, high, where=where)
    contours = edge_contours.link(mask, points)
    return tuple(fit(contours, linear(contours, k, t)) for k, t in settings)
