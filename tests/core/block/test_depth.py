from dataclasses import replace

import numpy as np
import shapely

from nostalgin_core.block.chain import chain
from nostalgin_core.records import Front
from tests.core.block.test_chain import ROUND, by_id, front


def test_a_gap_is_closed_by_a_wall_that_no_front_stands_on() -> None:
    fronts = [
        front(0, 0, "a", 10.0, address="101"),
        front(0, 1, "b", 10.0, address="103"),
        front(0, 2, "c", 10.0, address="121"),
        front(1, 3, "c", 40.0),
        front(2, 4, "d", 80.0),
        front(3, 5, "d", 40.0),
        front(3, 6, "a", 10.0),
    ]
    placed = by_id(chain(fronts))
    (name,) = [one for one in placed if "-gap-" in one]
    closing = placed[name]
    assert closing.front_ids == (None,) * 4
    np.testing.assert_allclose(closing.corners_m[0], placed["9-b"].corners_m[1])
    for one in placed.values():
        for front_id, a, b in zip(
            one.front_ids, one.corners_m, np.roll(one.corners_m, -1, 0), strict=True
        ):
            width = {one.front_id: one.width_m for one in fronts}.get(front_id or "")
            if width and one.building_id == "9-b":
                assert np.hypot(*(b - a)) < 1.03 * width


def test_what_an_unseen_end_leaves_of_its_side_is_closed_too() -> None:
    fronts = [
        front(0, 0, "a", 30.0, address="101"),
        front(0, 1, "b", 10.0, address="103"),
        front(1, 2, "b", 60.0),
        front(2, 3, "c", 8.0, address="200"),
        front(2, 4, "d", 14.0, address="202"),
        front(3, 5, "a", 60.0),
    ]
    ring = chain(fronts)
    grounds = [shapely.Polygon(one.corners_m).buffer(0.05) for one in ring.footprints]
    open_m = shapely.LinearRing(ring.outline_m).difference(shapely.union_all(grounds))
    assert open_m.length < 1e-6
    assert len({one.building_id for one in ring.footprints}) == len(ring.footprints)


def test_a_ring_of_sound_widths_misses_its_start_by_nothing() -> None:
    assert chain(ROUND).closure_m < 1e-9


def test_what_one_width_is_too_long_is_the_closure_error() -> None:
    fronts = list(ROUND)
    fronts[1] = replace(fronts[1], width_m=fronts[1].width_m + 3.0)
    assert abs(chain(fronts).closure_m - 3.0) < 1e-6


def test_a_lot_that_runs_through_tells_how_deep_a_block_is() -> None:
    def listed(side: int, rank: int, depth_m: float) -> Front:
        return front(side, rank, f"{rank}", 20.0, depth_m=depth_m)

    deep = [30.0, 30.0, 60.0, 30.0, 30.0]
    fronts = [listed(0, k, one) for k, one in enumerate(deep)]
    fronts += [listed(1, 5, 20.0)]
    fronts += [listed(2, 6 + k, 30.0) for k in range(5)]
    fronts += [listed(3, 11, 20.0)]
    outline_m = chain(fronts).outline_m
    assert abs(np.hypot(*(outline_m[2] - outline_m[1])) - 60.0) < 1.5
    flat = [replace(one, depth_m=30.0) for one in fronts]  # back to back: the same
    outline_m = chain(flat).outline_m
    assert abs(np.hypot(*(outline_m[2] - outline_m[1])) - 60.0) < 1.5
