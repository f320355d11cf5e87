from dataclasses import replace

import numpy as np
import pytest

from nostalgin_core.block.settle import Settled, settle
from nostalgin_core.records import Front
from tests.core import sample_block as sample


def named_once() -> list[Front]:
    """List the fronts as an archive does: one street a lot, the first."""
    return list({front.lot: front for front in reversed(sample.fronts("1"))}.values())[
        ::-1
    ]


def candidates(fronts: list[Front]) -> dict[str, list[str]]:
    photos = {photo for photo, _ in sample.elevations("1")}
    return {
        photo: [front.front_id for front in fronts if photo == f"photo-1-{front.lot}"]
        for photo in photos
    }


@pytest.fixture(scope="module")
def settled() -> Settled:
    fronts = named_once()
    return settle("1", fronts, candidates(fronts), sample.seen())


def test_photographs_alone_bring_back_the_corners_that_an_archive_leaves_out(
    settled: Settled,
) -> None:
    assert [one.front_id for one in settled.fronts] == [
        one.front_id for one in sample.fronts("1")
    ]


def test_every_facade_stands_where_it_was_painted(settled: Settled) -> None:
    given = {(one.front_id, one.photo, one.facade) for one in settled.assignments}
    truth = {(one.front_id, one.photo, one.facade) for one in sample.assignments("1")}
    assert given == truth
    assert not settled.rejections


def test_the_order_of_what_was_seen_changes_nothing(settled: Settled) -> None:
    fronts = named_once()
    again = settle("1", fronts, candidates(fronts), sample.seen()[::-1])
    assert again.assignments == settled.assignments
    for a, b in zip(again.block.buildings, settled.block.buildings, strict=True):
        np.testing.assert_array_equal(a.footprint_m, b.footprint_m)
        assert (a.building_id, a.height_m) == (b.building_id, b.height_m)
        assert [w.texture for w in a.walls] == [w.texture for w in b.walls]


def test_the_photograph_of_a_neighbour_moves_no_lot_but_its_own() -> None:
    fronts = named_once()
    sound = settle("1", fronts, candidates(fronts), sample.seen()).fronts
    for lot in dict.fromkeys(front.lot for front in fronts):
        lots = [front.lot for front in fronts]
        other = lots[(lots.index(lot) + 1) % len(lots)]
        shown = [one for one in sample.seen() if one.photo == f"photo-1-{other}"]
        rest = [one for one in sample.seen() if one.photo != f"photo-1-{lot}"]
        slipped = [replace(one, photo=f"photo-1-{lot}") for one in shown]
        found = settle("1", fronts, candidates(fronts), [*rest, *slipped]).fronts
        own = {lot, other}
        before = [(f.front_id, f.side) for f in sound if f.lot not in own]
        after = [(f.front_id, f.side) for f in found if f.lot not in own]
        assert before == after
