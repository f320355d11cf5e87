from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import shapely

from nostalgin_core.block.chain import Footprint, Ring, chain
from nostalgin_core.block.pieces import pieces, with_corners
from nostalgin_core.records import Front
from tests.core import listed


def front(side: int, rank: int, lot: str, width_m: float, **more: Any) -> Front:
    plain: dict[str, Any] = {"address": "", "depth_m": 12.0}
    return listed.front(lot, side, rank, width_m=width_m, **plain | more)


# A block of 60 by 40 metres; lots a, c, e, g stand round its corners.
ROUND = (
    front(0, 0, "a", 20.0, depth_m=15.0),
    front(0, 1, "b", 25.0, depth_m=14.0),
    front(0, 2, "c", 15.0, depth_m=18.0),
    front(1, 3, "c", 18.0, depth_m=15.0),
    front(1, 4, "d", 10.0),
    front(1, 5, "e", 12.0, depth_m=30.0),
    front(2, 6, "e", 30.0, depth_m=12.0),
    front(2, 7, "f", 18.0),
    front(2, 8, "g", 12.0, depth_m=10.0),
    front(3, 9, "g", 10.0, depth_m=12.0),
    front(3, 10, "h", 15.0, depth_m=8.0),
    front(3, 11, "a", 15.0, depth_m=20.0),
)


def by_id(ring: Ring) -> dict[str, Footprint]:
    return {one.building_id: one for one in ring.footprints}


def area(footprint: Footprint) -> float:
    return shapely.Polygon(footprint.corners_m).area


def test_a_consistent_block_is_placed_as_it_is() -> None:
    placed = by_id(chain(ROUND))
    expected = {
        "9-b": [[20, 0], [45, 0], [45, 14], [20, 14]],
        "9-c": [[45, 0], [60, 0], [60, 18], [45, 18]],
        "9-d": [[60, 18], [60, 28], [48, 28], [48, 18]],
        "9-e": [[60, 28], [60, 40], [30, 40], [30, 28]],
        "9-g": [[12, 40], [0, 40], [0, 30], [12, 30]],
        "9-a": [[0, 15], [0, 0], [20, 0], [20, 15]],
    }
    for name, corners_m in expected.items():
        np.testing.assert_allclose(placed[name].corners_m, corners_m, atol=1e-6)


def test_every_building_is_built_once() -> None:
    names = [one.building_id for one in chain(ROUND).footprints]
    assert sorted(names) == sorted({f"9-{one.lot}" for one in ROUND})


def test_the_order_is_that_of_the_ring() -> None:
    names = "".join(one.building_id[-1] for one in chain(ROUND).footprints)
    assert names in "bcdefgha" * 2


def test_a_corner_building_has_both_its_fronts_side_by_side() -> None:
    corner = by_id(chain(ROUND))["9-c"]
    assert corner.front_ids == ("9-c-0", "9-c-1", None, None)
    assert corner.turns == 1


def test_each_front_runs_from_left_to_right_seen_from_its_street() -> None:
    for one in chain(ROUND).footprints:
        assert shapely.LinearRing(one.corners_m).is_ccw


@pytest.mark.parametrize("count", [3, 4, 5, 6])
@pytest.mark.parametrize("seed", range(3))
def test_no_two_buildings_overlap_whatever_the_widths(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    fronts = []
    for side in range(count):
        for _ in range(rng.integers(1, 6)):
            width, depth = rng.uniform(6, 40), rng.uniform(8, 50)
            name = f"{len(fronts)}"
            fronts.append(front(side, len(fronts), name, width, depth_m=depth))
    ring = chain(fronts)
    shapes = [shapely.Polygon(one.corners_m) for one in ring.footprints]
    for index, a in enumerate(shapes):
        assert a.is_valid
        for b in shapes[index + 1 :]:
            assert a.intersection(b).area < 0.01 * min(a.area, b.area) + 1e-3


@pytest.mark.parametrize("seed", range(5))
def test_fronts_stand_on_the_outline(seed: int) -> None:
    rng = np.random.default_rng(seed)
    fronts = [
        front(
            side, 3 * side + k, f"{side}{k}", rng.uniform(5, 30), width_assumed=k == 1
        )
        for side in range(4)
        for k in range(3)
    ]
    ring = chain(fronts)
    street = shapely.LinearRing(ring.outline_m).buffer(1e-6)
    for one in ring.footprints:
        for edge, front_id in enumerate(one.front_ids):
            if front_id is not None:
                ends = one.corners_m[[edge, (edge + 1) % 4]]
                assert street.covers(shapely.MultiPoint(ends))


def test_without_a_two_fronted_lot_the_ring_still_turns_and_closes() -> None:
    fronts = [front(side, side, "abcd"[side], 30.0) for side in range(4)]
    ring = chain(fronts)
    assert len(ring.outline_m) == 4
    assert len(ring.footprints) == 4
    assert all(one.turns == 1 for one in ring.footprints)


def test_a_measured_width_hardly_moves_where_an_assumed_one_gives_way() -> None:
    fronts = list(ROUND)
    fronts[1] = front(0, 1, "b", 35.0, depth_m=14.0, width_assumed=True)
    fronts[7] = front(2, 7, "f", 18.0)
    placed = by_id(chain(fronts))
    assert abs(placed["9-c"].corners_m[1, 0] - placed["9-c"].corners_m[0, 0] - 15) < 0.5
    width = placed["9-b"].corners_m[1, 0] - placed["9-b"].corners_m[0, 0]
    assert 24 < width < 35


def test_missing_lots_leave_a_gap_where_house_numbers_jump() -> None:
    fronts = [
        front(0, 0, "a", 10.0, address="101"),
        front(0, 1, "b", 10.0, address="103"),
        front(0, 2, "c", 10.0, address="121"),
        front(0, 3, "d", 10.0, address="123"),
        front(1, 4, "d", 40.0),
        front(1, 5, "e", 10.0),
        front(2, 6, "e", 80.0),
        front(3, 7, "f", 40.0),
        front(3, 8, "a", 10.0),
    ]
    placed = by_id(chain(fronts))
    gap = placed["9-c"].corners_m[0] - placed["9-b"].corners_m[1]
    assert gap[0] > 20
    assert abs(gap[1]) < 1e-6
    touching = placed["9-b"].corners_m[0] - placed["9-a"].corners_m[2]
    np.testing.assert_allclose(touching, 0, atol=1e-6)


def test_one_side_is_a_straight_row() -> None:
    ring = chain([front(0, k, f"{k}", 8.0 + k, depth_m=None) for k in range(3)])
    assert not ring.closed
    np.testing.assert_allclose(ring.outline_m, [[0, 0], [27, 0]], atol=1e-9)
    np.testing.assert_allclose(ring.footprints[1].corners_m[0], [8, 0], atol=1e-9)


def test_two_sides_are_an_open_corner() -> None:
    fronts = [front(0, 0, "a", 10.0), front(0, 1, "b", 12.0), front(1, 2, "b", 9.0)]
    ring = chain([*fronts, front(1, 3, "c", 7.0)])
    assert [one.building_id for one in ring.footprints] == ["9-a", "9-b", "9-c"]
    np.testing.assert_allclose(ring.outline_m, [[0, 0], [22, 0], [22, 16]], atol=1e-9)


def test_a_lot_beside_an_empty_side_takes_it_whole() -> None:
    fronts = [
        front(0, 0, "a", 30.0),
        front(0, 1, "b", 30.0, depth_m=40.0),
        front(1, 2, "b", 40.0, depth_m=30.0),
        front(3, 3, "c", 20.0),
        front(3, 4, "a", 20.0, depth_m=30.0),
    ]
    ring = chain(fronts)
    assert by_id(ring)["9-b"].turns + by_id(ring)["9-c"].turns == 3
    assert ring.closed


def test_a_leaning_side_leans_as_told() -> None:
    lean = 0.2
    ring = chain(ROUND, leaning={1: lean})
    assert ring.headings_rad[1] == pytest.approx(np.pi / 2 + lean)
    assert ring.headings_rad[2] == pytest.approx(np.pi)


def test_an_empty_ring_is_refused() -> None:
    with pytest.raises(ValueError, match="at least one front"):
        chain([])


def owners(fronts: list[Front]) -> dict[tuple[int, int], str]:
    """Tell which lot stands round the corner of each two sides."""
    found = {}
    sides = with_corners(pieces(fronts))
    for here, side in enumerate(sides):
        there = (here + 1) % len(sides)
        assert side[-1].building_id == sides[there][0].building_id
        found[here, there] = side[-1].lot
    return found


def on(street: str, one: Front) -> Front:
    return replace(one, street=street)


def test_an_unclaimed_corner_goes_to_the_lot_on_the_avenue() -> None:
    fronts = [
        on("10 Street", front(0, 0, "1", 20.0)),
        on("First Avenue", front(1, 1, "5", 20.0)),
        on("First Avenue", front(1, 2, "6", 20.0)),
        on("First Avenue", front(1, 3, "7", 20.0)),
        on("11 Street", front(2, 4, "9", 20.0)),
        on("11 Street", front(2, 5, "10", 20.0)),
        on("Second Avenue", front(3, 6, "14", 20.0)),
        on("Second Avenue", front(3, 7, "15", 20.0)),
    ]
    assert owners(fronts) == {(0, 1): "5", (1, 2): "7", (2, 3): "14", (3, 0): "15"}


def test_a_lot_alone_on_its_side_takes_the_corner_that_its_lot_is_nearer_to() -> None:
    fronts = [
        on("10 Street", front(0, 0, "22", 30.0)),
        on("10 Street", front(0, 1, "29", 30.0)),
        on("First Avenue", front(1, 2, "36", 25.0)),
        on("11 Street", front(2, 3, "38", 30.0)),
        on("11 Street", front(2, 4, "43", 30.0)),
        on("Second Avenue", front(3, 5, "47", 30.0)),
        on("Second Avenue", front(3, 6, "11", 30.0)),
    ]
    assert owners(fronts) == {(0, 1): "29", (1, 2): "36", (2, 3): "47", (3, 0): "11"}


def test_a_lot_as_long_as_its_side_takes_both_corners() -> None:
    fronts = [
        on("10 Street", front(0, 0, "22", 60.0)),
        on("First Avenue", front(1, 1, "36", 58.0)),
        on("11 Street", front(2, 2, "38", 60.0)),
        on("Second Avenue", front(3, 3, "47", 30.0)),
        on("Second Avenue", front(3, 4, "49", 30.0)),
    ]
    got = owners(fronts)
    assert got[0, 1] == got[1, 2] == "36"


def test_a_lot_on_opposite_streets_is_two_buildings_of_different_names() -> None:
    through = [
        front(0, 0, "a", 30.0),
        front(1, 1, "b", 20.0),
        front(1, 2, "c", 20.0),
        front(2, 3, "d", 15.0),
        front(2, 4, "t", 15.0),
        front(3, 5, "e", 40.0),
        front(0, 6, "t", 20.0),
        front(0, 7, "f", 20.0),
    ]
    ring = chain(through)
    names = [one.building_id for one in ring.footprints]
    assert len(names) == len(set(names))
    assert len([name for name in names if "-gap-" not in name]) == 8
    assert {"9-t", "9-t-2"} <= set(names)
    stood = {name for one in ring.footprints for name in one.front_ids if name}
    assert stood == {one.front_id for one in through}
