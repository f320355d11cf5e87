"""What lies between two places of a ring is what a walk from one to the other meets."""

import tracemalloc
from collections.abc import Callable, Sequence

import numpy as np
import pytest

from nostalgin_core.records import Front
from nostalgin_core.views import claimed
from nostalgin_core.views.order import beginning
from nostalgin_core.views.places import FARTHEST, places, ringed
from tests.core import listed
from tests.core.views.test_claims import photographed, ring


def row(count: int) -> list[Front]:
    """List the fronts of one long street, each lot with a number of its own."""
    return [
        listed.front(str(i), 0, i, width_m=6.0 + i % 7, address=str(2 * i + 1))
        for i in range(count)
    ]


@pytest.mark.parametrize("fronts", [ring(), row(1), row(2), row(9), ring()[:8]])
def test_what_lies_between_is_what_a_walk_meets(fronts: Sequence[Front]) -> None:
    found, measured = places(fronts), ringed(fronts)
    n = len(found)
    assert measured.on.shape == (n, min(FARTHEST, n - 1))
    for start in range(n):
        corners, between_m, absent = 0, 0.0, 1.0
        for k in range(measured.on.shape[1]):
            before, here = found[start + k - n], found[(start + k + 1) % n]
            corners += before.front.side != here.front.side
            assert found[measured.on[start, k]] is here
            assert measured.corners[start, k] == corners
            assert measured.between_m[start, k] == pytest.approx(between_m)
            assert measured.absent[start, k] == pytest.approx(absent)
            sure = here.kind == "listed"
            between_m += here.front.width_m if sure else 0.0
            absent *= 1.0 if sure else 1 - here.present


def peak(work: Callable[[], object]) -> int:
    """Tell the most bytes that some work holds."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_memory_grows_with_the_fronts_and_not_with_their_square() -> None:
    def work(count: int) -> int:
        fronts = row(count)
        seen = photographed(fronts, (2, 3, 4, 5), 3)
        return peak(lambda: claimed(fronts, {"p": ["9-3-0"]}, seen))

    work(50)  # what is loaded once counts for nothing
    assert work(1600) < 2.5 * work(800)


@pytest.mark.parametrize("filed", [{"0"}, {"7", "30"}, {"20", "21", "37"}])
def test_a_photograph_begins_near_its_lots_either_way_round(filed: set[str]) -> None:
    measured = ringed(ring())
    n = len(measured.places)
    own = [i for i, one in enumerate(measured.places) if one.front.lot in filed]
    apart = [min(min((i - o) % n, (o - i) % n) for o in own) for i in range(n)]
    found = beginning(measured, filed)
    assert found.sum() == pytest.approx(1)
    for steps in range(max(apart)):
        here = [p for p, far in zip(found, apart, strict=True) if far == steps]
        beyond = [p for p, far in zip(found, apart, strict=True) if far == steps + 1]
        assert np.ptp(here) == pytest.approx(0, abs=1e-15)
        assert min(here) > max(beyond)
