"""Closed-form matting solves for alpha on the unknown band alone, without iterating.

In a small window k, alpha is nearly an affine function of the gray level I, and the
cost of departing from that is a quadratic form whose matrix is the *matting Laplacian*
(Levin, Lischinski and Weiss, "A Closed-Form Solution to Natural Image Matting", PAMI
2008, equation 12). For one channel, windows of n = 9 pixels with mean mu_k and variance
sigma_k^2, it is

    L_ij = sum over k containing i and j of
           delta_ij - (1/n) (1 + (I_i - mu_k) (I_j - mu_k) / v_k),
    v_k = sigma_k^2 + epsilon/n.

The sum over k splits into three that know nothing of i and j but which windows hold
both, so that each diagonal of the matrix costs a few vector operations:

    L_ij = delta_ij count_i - (A_ij - (I_i + I_j) B_ij + I_i I_j S_ij)
    A = sum (1 + mu^2/v)/n,   B = sum mu/(n v),   S = sum 1/(n v)

Known pixels are constants, so only rows of unknown pixels are assembled, from windows
that touch them. Unknown pixels form thin bands, and numbered along a band (reverse
Cuthill-McKee) their matrix is banded too, about four times as wide as the band is in
pixels. LAPACK's banded Cholesky then solves it exactly, several times faster than a
general sparse factorisation; that one is left for bands that branch too much.
"""

from collections.abc import Iterator
from typing import Final, NamedTuple

import cv2
import numpy as np
from jaxtyping import Float, Float32, Int, Int32
from scipy import linalg, sparse
from scipy.sparse import csgraph
from scipy.sparse.linalg import splu

from nostalgin_core.arrays import Alpha, Gray, Mask
from nostalgin_core.trimap import BACKGROUND, FOREGROUND, Trimap

EPSILON: Final = 1e-7  # Levin's own: squared gray levels, where white is 1
ENTRIES: Final = 8_000_000  # of one factor: 64 MB
WIDEST: Final = 400  # from this matrix bandwidth on, a sparse factorisation is faster
_OVERLAP_PX: Final = 8  # of parts that are solved one after the other
_PAD: Final = 2  # how far a window that holds a pixel reaches from it
_N: Final = 9

_Light = Float32[np.ndarray, "h w"]


class Belief(NamedTuple):
    """What alpha probably is, and how strongly: against a diagonal of order 1."""

    alpha: Alpha
    weight: float


class System(NamedTuple):
    """The equations L_uu alpha_u = -L_uk alpha_k, upper half, by diagonals.

    `values[d, p]` couples unknown p with unknown `neighbours[d, p]`, which comes later
    in the order of reading (or is p itself, for d = 0); -1 where that pixel is known.
    """

    values: Float[np.ndarray, "d n"]
    neighbours: Int32[np.ndarray, "d n"]
    right: Float[np.ndarray, " n"]


def alpha(
    image: Gray,
    trimap: Trimap,
    *,
    prior: Belief | None = None,
    epsilon: float = EPSILON,
    entries: int = ENTRIES,
) -> _Light:
    """Find the alpha of least cost that agrees with the trimap where it is known.

    A band whose factor has more than `entries` numbers is solved at half the size
    first. There, alpha is brought to full size by its own local affine model, and
    solved again, part by part, where it is neither 0 nor 1: bounded memory, and for
    crisp outlines little work.

    Args:
        image: What the camera saw.
        trimap: Codes of `trimap`.
        prior: What to believe where the image does not tell.
        epsilon: n times the variance below which a window counts as even; white is 1.
        entries: The size of the largest factor.

    Raises:
        ValueError: if the trimap knows no pixel at all.
    """
    if not ((trimap == BACKGROUND) | (trimap == FOREGROUND)).any():
        message = f"a trimap of {trimap.shape} without a known pixel"
        raise ValueError(message)
    light = image.astype(np.float32) / np.float32(255.0)
    result = _solve(light, trimap, prior, epsilon, entries)
    return np.clip(result, 0.0, 1.0)


def _solve(
    light: _Light, trimap: Trimap, prior: Belief | None, epsilon: float, entries: int
) -> _Light:
    unknown = (trimap != BACKGROUND) & (trimap != FOREGROUND)
    result = (trimap == FOREGROUND).astype(np.float32)
    if order(unknown).entries > entries:
        guess = _from_half(light, trimap, prior, epsilon, entries)
        unsettled = ((guess > 0.002) & (guess < 0.998)).astype(np.uint8)
        result[unknown] = np.round(guess[unknown])
        unknown &= cv2.dilate(unsettled, np.ones((5, 5), np.uint8)) > 0
        result[unknown] = guess[unknown]
    for part in _parts(unknown, entries):
        result[part] = _exactly(light, part, result, prior, epsilon)
    return result


def _parts(unknown: Mask, entries: int) -> Iterator[Mask]:
    """Split a band until each part's factor is small enough, with some overlap.

    The parts are solved one after the other, each with the others' alpha as it is: what
    the coarse solution missed is local.
    """
    if order(unknown).entries <= entries:
        yield unknown
        return
    places = np.nonzero(unknown)
    axis = int(np.argmax([np.ptp(axis) for axis in places]))
    middle = int(np.median(places[axis]))
    for side in (slice(middle + _OVERLAP_PX), slice(middle - _OVERLAP_PX, None)):
        half = np.zeros_like(unknown)
        cut = (side, slice(None)) if axis == 0 else (slice(None), side)
        half[cut] = unknown[cut]
        yield from _parts(half, entries)


def _exactly(
    light: _Light,
    unknown: Mask,
    known: _Light,
    prior: Belief | None,
    epsilon: float,
) -> Float[np.ndarray, " n"]:
    """Solve for the unknown pixels at once."""
    if not unknown.any():
        return np.empty(0)
    y, x = (np.flatnonzero(unknown.any(axis=axis)) for axis in (1, 0))
    part = tuple(slice(max(0, a[0] - _PAD), a[-1] + _PAD + 1) for a in (y, x))
    here = prior and Belief(prior.alpha[part], prior.weight)
    equations = system(
        light[part], unknown[part], known[part], prior=here, epsilon=epsilon
    )
    numbering = order(unknown[part])
    solver = banded_solve if numbering.reach < WIDEST else sparse_solve
    return solver(equations, numbering.ranks)


def system(
    light: Float[np.ndarray, "h w"],
    unknown: Mask,
    known: Alpha,
    *,
    prior: Belief | None = None,
    epsilon: float = EPSILON,
) -> System:
    """Assemble the equations of the unknown pixels, in the order of reading."""
    h, w = light.shape
    padded = cv2.copyMakeBorder(
        light.astype(np.float64), *[_PAD] * 4, cv2.BORDER_CONSTANT
    )
    levels = padded.ravel()
    pixels, number = _numbered(unknown)
    known_alpha = np.pad(np.where(unknown, 0.0, known), _PAD).ravel()
    held, right = _windows(padded, unknown, known_alpha, pixels, epsilon)
    here = levels[pixels]
    values = np.empty((len(_LATER), len(pixels)))
    neighbours = np.empty((len(_LATER), len(pixels)), np.int32)
    for d, (dy, dx) in enumerate(_LATER):
        there = pixels + (dy * padded.shape[1] + dx)
        a, b, s = _overlap(held, dy, dx)
        light_there = levels[there]
        values[d] = (here + light_there) * b - a - here * light_there * s
        neighbours[d] = number[there]
    y, x = np.nonzero(unknown)
    values[0] += _count(y, h) * _count(x, w)
    if prior is not None:
        values[0] += prior.weight
        right += prior.weight * prior.alpha[unknown]
    return System(values, neighbours, right)


# Where a pixel's later neighbours lie; the earlier ones follow from symmetry.
_LATER: Final = [
    (dy, dx) for dy in range(3) for dx in range(-2, 3) if dy > 0 or dx >= 0
]


def _numbered(
    unknown: Mask,
) -> tuple[Int[np.ndarray, " n"], Int32[np.ndarray, " padded"]]:
    """Give the unknowns' places in the padded image, and every place's number or -1."""
    padded = np.pad(unknown, _PAD).ravel()
    pixels = np.flatnonzero(padded)
    number = np.full(padded.size, -1, np.int32)
    number[pixels] = np.arange(len(pixels), dtype=np.int32)
    return pixels, number


def _count(places: Int[np.ndarray, " n"], size: int) -> Int[np.ndarray, " n"]:
    """Count, along one axis, the whole windows that hold each place."""
    return np.minimum(places + 1, size - 2) - np.maximum(places - 1, 1) + 1


def _windows(
    padded: Float[np.ndarray, "padded_h padded_w"],
    unknown: Mask,
    known_alpha: Float[np.ndarray, " padded"],
    pixels: Int[np.ndarray, " n"],
    epsilon: float,
) -> tuple[Float[np.ndarray, "3 3 3 n"], Float[np.ndarray, " n"]]:
    """Give each unknown A, B and S of its nine windows, and its right side.

    With beta the slope that alpha's known part has against I in a window, the right
    side is the sum over windows of mean(alpha) + beta (I_i - mu). A window that reaches
    out of the image counts nothing.
    """
    width = padded.shape[1]
    touched = cv2.dilate(unknown.astype(np.uint8), np.ones((3, 3), np.uint8))
    touched[[0, -1]] = 0
    touched[:, [0, -1]] = 0
    centres = np.flatnonzero(np.pad(touched, _PAD))
    around = [dy * width + dx for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
    lights = np.stack([padded.ravel()[centres + step] for step in around])
    alphas = np.stack([known_alpha[centres + step] for step in around])
    mean = lights.mean(axis=0)
    lights -= mean
    s = 1.0 / ((lights * lights).sum(axis=0) + epsilon)
    beta = (lights * alphas).sum(axis=0) * s
    # The last column is the window that counts nothing.
    fields = np.zeros((5, len(centres) + 1))
    fields[:, :-1] = (
        1.0 / _N + mean * mean * s,
        mean * s,
        s,
        alphas.mean(axis=0) - beta * mean,
        beta,
    )
    number = np.full(padded.size, len(centres), np.int32)
    number[centres] = np.arange(len(centres), dtype=np.int32)
    held = np.empty((5, 9, len(pixels)))
    for place, step in enumerate(around):
        np.take(fields, number[pixels + step], axis=1, out=held[:, place], mode="clip")
    right = held[3].sum(axis=0) + padded.ravel()[pixels] * held[4].sum(axis=0)
    return held[:3].reshape(3, 3, 3, -1), right


def _overlap(
    held: Float[np.ndarray, "3 3 3 n"], dy: int, dx: int
) -> Float[np.ndarray, "3 n"]:
    """Add up the windows that hold both a pixel and its neighbour at (dy, dx)."""
    ys = range(max(0, dy), min(3, 3 + dy))
    xs = range(max(0, dx), min(3, 3 + dx))
    total = np.zeros_like(held[:, 0, 0])
    for y in ys:
        for x in xs:
            total += held[:, y, x]
    return total


class Order(NamedTuple):
    """A numbering of the unknowns along their bands."""

    ranks: Int[np.ndarray, " n"]
    reach: int  # the greatest difference of rank between coupled unknowns

    @property
    def entries(self) -> int:
        """Estimate the size of a factor."""
        return len(self.ranks) * min(self.reach + 1, WIDEST)


def order(unknown: Mask) -> Order:
    """Number the unknowns along their bands, so that neighbours have near numbers."""
    pixels, number = _numbered(unknown)
    width = unknown.shape[1] + 2 * _PAD
    steps = [dy * width + dx for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
    neighbours = np.stack([number[pixels + step] for step in steps], axis=1)
    present = neighbours >= 0
    starts = np.concatenate([[0], np.cumsum(present.sum(axis=1))]).astype(np.int32)
    indices = neighbours[present]
    graph = sparse.csr_array(
        (np.ones(len(indices), np.int8), indices, starts), shape=[len(pixels)] * 2
    )
    ranks = np.empty(len(pixels), np.int64)
    if len(pixels):
        along = csgraph.reverse_cuthill_mckee(graph, symmetric_mode=True)
        ranks[along] = np.arange(len(pixels))
    reach = 0
    for dy, dx in _LATER:
        there = number[pixels + (dy * width + dx)]
        both = there >= 0
        spread = np.abs(ranks[both] - ranks[there[both]])
        reach = max(reach, int(spread.max(initial=0)))
    return Order(ranks, reach)


def banded_solve(
    equations: System, ranks: Int[np.ndarray, " n"]
) -> Float[np.ndarray, " n"]:
    """Solve by banded Cholesky, with the unknowns numbered by `ranks`."""
    values, rows, columns = _entries(equations, ranks)
    spread = np.abs(rows - columns)
    shape = (int(spread.max(initial=0)) + 1, len(ranks))
    band = np.zeros(shape, order="F")  # LAPACK's lower form
    band[spread, np.minimum(rows, columns)] = values
    right = np.empty(len(ranks))
    right[ranks] = equations.right
    solved = linalg.solveh_banded(
        band, right, lower=True, overwrite_ab=True, overwrite_b=True, check_finite=False
    )
    return solved[ranks]


def sparse_solve(
    equations: System, ranks: Int[np.ndarray, " n"]
) -> Float[np.ndarray, " n"]:
    """Solve by sparse factorisation, with an ordering of its own."""
    n = len(ranks)
    values, rows, columns = _entries(equations, np.arange(n))
    other = rows != columns
    matrix = sparse.coo_array(
        (
            np.concatenate([values, values[other]]),
            (
                np.concatenate([rows, columns[other]]),
                np.concatenate([columns, rows[other]]),
            ),
        ),
        shape=(n, n),
    )
    # It is positive definite: no pivot is ever needed.
    factor = splu(
        matrix.tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    return factor.solve(equations.right)


def _entries(
    equations: System, ranks: Int[np.ndarray, " n"]
) -> tuple[Float[np.ndarray, " m"], Int[np.ndarray, " m"], Int[np.ndarray, " m"]]:
    """List the upper half's values with the ranks of the unknowns they couple."""
    present = equations.neighbours >= 0
    rows = np.broadcast_to(ranks, present.shape)[present]
    columns = ranks[equations.neighbours[present]]
    return equations.values[present], rows, columns


def _from_half(
    light: _Light, trimap: Trimap, prior: Belief | None, epsilon: float, entries: int
) -> _Light:
    """Solve at half the size, and bring alpha up by its affine model of the image.

    This is the coarse-to-fine scheme of Levin's published program.
    """
    h, w = light.shape
    half = ((w + 1) // 2, (h + 1) // 2)

    def down(array: np.ndarray) -> np.ndarray:
        even = cv2.copyMakeBorder(array, 0, h % 2, 0, w % 2, cv2.BORDER_REPLICATE)
        return cv2.resize(even, half, interpolation=cv2.INTER_AREA)

    small = np.full(half[::-1], 128, np.uint8)
    small[down((trimap == FOREGROUND).astype(np.float32)) >= 1.0] = FOREGROUND
    small[down((trimap == BACKGROUND).astype(np.float32)) >= 1.0] = BACKGROUND
    if (small == 128).all():
        return np.full(light.shape, 0.5, np.float32)
    dim = down(light)
    belief = prior and Belief(down(prior.alpha.astype(np.float32)), prior.weight)
    slope, offset = _affine(dim, _solve(dim, small, belief, epsilon, entries), epsilon)
    size = (2 * half[0], 2 * half[1])
    up = [cv2.resize(x, size, interpolation=cv2.INTER_LINEAR) for x in (slope, offset)]
    return np.clip(up[0][:h, :w] * light + up[1][:h, :w], 0.0, 1.0)


def _affine(light: _Light, matte: _Light, epsilon: float) -> tuple[_Light, _Light]:
    """Fit alpha = slope * light + offset in each window, and average the fits."""

    def mean(x: np.ndarray) -> np.ndarray:
        return cv2.blur(x, (3, 3), borderType=cv2.BORDER_REFLECT)

    x, y = light.astype(np.float64), matte.astype(np.float64)
    mean_x, mean_y = mean(x), mean(y)
    slope = (mean(x * y) - mean_x * mean_y) / (
        np.maximum(mean(x * x) - mean_x * mean_x, 0.0) + epsilon / _N
    )
    offset = mean_y - slope * mean_x
    return mean(slope).astype(np.float32), mean(offset).astype(np.float32)
