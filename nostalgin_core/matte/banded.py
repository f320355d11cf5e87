"""A thin band's equations are banded, and then solved exactly in little time.

Unknown pixels form thin bands. Numbered along the band (reverse Cuthill-McKee), their
matrix is banded too, about four times as wide as the band is in pixels. LAPACK's banded
Cholesky solves it several times faster than a general sparse factorisation; that one is
left for bands that branch too much.
"""

from typing import Final, NamedTuple

import numpy as np
from jaxtyping import Float, Int
from scipy import linalg, sparse
from scipy.sparse import csgraph
from scipy.sparse.linalg import splu

from nostalgin_core.arrays import Mask
from nostalgin_core.matte.laplacian import LATER, PAD, System, numbered

WIDEST: Final = 400  # from this matrix bandwidth on, a sparse factorisation is faster


class Order(NamedTuple):
    """A numbering of the unknowns along their bands."""

    ranks: Int[np.ndarray, " n"]
    reach: int  # the greatest difference of rank between coupled unknowns


def order(unknown: Mask) -> Order:
    """Number the unknowns along their bands, so that neighbours have near numbers."""
    pixels, number = numbered(unknown)
    width = unknown.shape[1] + 2 * PAD
    steps = [dy * width + dx for dy in range(-2, 3) for dx in range(-2, 3)]
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
    for dy, dx in LATER:
        there = number[pixels + (dy * width + dx)]
        both = there >= 0
        spread = np.abs(ranks[both] - ranks[there[both]])
        reach = max(reach, int(spread.max(initial=0)))
    return Order(ranks, reach)


def solve(
    equations: System, numbering: Order, *, precise: bool = True
) -> Float[np.ndarray, " n"]:
    """Solve in the way that suits the bandwidth.

    Unless `precise`, a band is factorised in float32: half the time and the memory,
    for matrices that are far from singular.
    """
    if numbering.reach < WIDEST:
        return banded_solve(equations, numbering.ranks, precise=precise)
    return sparse_solve(equations, numbering.ranks)


def banded_solve(
    equations: System, ranks: Int[np.ndarray, " n"], *, precise: bool = True
) -> Float[np.ndarray, " n"]:
    """Solve by banded Cholesky, with the unknowns numbered by `ranks`."""
    values, rows, columns = _entries(equations, ranks)
    spread = np.abs(rows - columns)
    shape = (int(spread.max(initial=0)) + 1, len(ranks))
    kind = np.float64 if precise else np.float32
    band = np.zeros(shape, kind, order="F")  # LAPACK's lower form
    band[spread, np.minimum(rows, columns)] = values
    right = np.empty(len(ranks), kind)
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
