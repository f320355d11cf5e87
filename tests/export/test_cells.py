import numpy as np
import pytest

from export.cells import CELL_PX, cells
from export.segmentation_data import Sample, Thing, fill
from tests.export.painted_segmentation import painted, rectangle

SIZE = (128, 128)


def _sample(*things: Thing) -> Sample:
    return Sample("a sample", np.zeros(SIZE, np.uint8), things)


def test_shares_sum_to_one_but_for_far_rows() -> None:
    sample = painted(3)
    shares = cells(sample)[:3].sum(0)
    assert shares.min() >= 0
    assert shares.max() <= 1 + 1e-6
    far = fill(sample.things[2].rings, SIZE)
    there = far.reshape(32, CELL_PX, 32, CELL_PX).mean((1, 3))
    np.testing.assert_allclose(shares, 1 - there, atol=1e-6)


def test_an_outline_cuts_the_cells_it_meets() -> None:
    front = Thing("facade", rectangle(10, 20, 69, 99), 0)
    shares = cells(_sample(front))[1]
    whole = fill(front.rings, SIZE)
    assert shares.sum() * CELL_PX**2 == pytest.approx(whole.sum())
    assert shares[10, 2] == pytest.approx(0.5)  # columns 8 to 11, of which 10 and 11


def test_what_hides_a_front_takes_its_cells() -> None:
    front = Thing("facade", rectangle(0, 0, 127, 99), 0)
    car = Thing("vehicle", rectangle(40, 60, 79, 119), 1)
    planes = cells(_sample(front, car))
    assert planes[2, 16:24, 11:19].min() == 1
    assert planes[1, 16:24, 11:19].max() == 0


def test_ends_lie_on_outlines_and_count_where_nothing_stands_before() -> None:
    front = Thing("facade", rectangle(30, 20, 90, 100), 0)
    planes = cells(_sample(front, Thing("person", rectangle(80, 80, 110, 120), 1)))
    ends, seen = planes[3] > 0, planes[4] > 0
    assert ends[5:20, 7].all()
    assert not ends[:, 10:20][8:22].any()
    assert seen[10, 7]
    assert not seen[22, 22]
    assert set(np.unique(planes[3:])) <= {0.0, 1.0}
