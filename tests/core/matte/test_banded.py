import cv2
import numpy as np

from nostalgin_core.matte import banded, laplacian
from tests.core.matte.dense import noise, whole


def test_both_solvers_find_the_dense_solution() -> None:
    light = noise(20, 24)
    unknown = np.zeros((20, 24), bool)
    unknown[2:7, 3:20] = unknown[12:16, 1:9] = True
    known = (np.arange(24) > 12) * np.ones((20, 1))
    system = laplacian.system(light, unknown, known)
    ranks = banded.order(unknown).ranks
    assert sorted(ranks) == list(range(len(ranks)))
    dense = np.linalg.solve(whole(system), system.right)
    for solve in (banded.banded_solve, banded.sparse_solve):
        np.testing.assert_allclose(solve(system, ranks), dense, atol=1e-7)


def test_what_is_far_from_singular_may_be_solved_imprecisely() -> None:
    unknown = np.zeros((40, 50), bool)
    unknown[3:37, 5:12] = unknown[20:29, 12:46] = True
    believed = laplacian.Belief(noise(40, 50, seed=1), 0.01)
    system = laplacian.system(
        noise(40, 50), unknown, np.ones((40, 50)), prior=believed, epsilon=1e-5
    )
    numbering = banded.order(unknown)
    rough = banded.solve(system, numbering, precise=False)
    assert rough.dtype == np.float32
    np.testing.assert_allclose(rough, banded.solve(system, numbering), atol=1e-4)


def test_a_ring_is_a_few_times_as_wide_as_its_band() -> None:
    disc = np.zeros((300, 300), np.uint8)
    cv2.circle(disc, (150, 150), 110, 1, 8)
    ring = banded.order(disc > 0)
    assert ring.reach + 1 < 8 * 9


def test_bands_that_all_but_touch_are_numbered_together() -> None:
    """A window couples pixels two apart, across a known pixel between them."""
    unknown = np.zeros((200, 40), bool)
    unknown[:, 10:16] = unknown[:, 17:23] = True
    filled = unknown.copy()
    filled[:, 16] = True
    assert banded.order(unknown).reach < banded.WIDEST
    assert banded.order(unknown).reach <= banded.order(filled).reach
