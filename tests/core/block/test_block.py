from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import shapely

from nostalgin_core import address
from nostalgin_core.block import block, widths
from nostalgin_core.block.cuboid import Shown
from nostalgin_core.records import Front
from tests.core import listed
from tests.core import sample_block as sample


def front(
    ring: int, side: int, lot: str, place: tuple[str, str], width_m: float
) -> Front:
    street, address = place
    more: dict[str, Any] = {"street": street, "address": address, "depth_m": 10.0}
    return listed.front(lot, side, side, ring=ring, width_m=width_m, **more)


# Two rings that Broadway cuts apart: a wide one to the west, a narrow one to the east.
WEST = [
    front(0, 0, "1", ("South Street", "147"), 60.0),
    front(0, 1, "2", ("Broadway", "1431"), 62.0),
    front(0, 2, "3", ("North Street", "150"), 45.0),
    front(0, 3, "4", ("7 Avenue", "561"), 60.0),
]
EAST = [
    front(1, 0, "5", ("South Street", "119"), 80.0),
    front(1, 1, "6", ("6 Avenue", "1071"), 60.0),
    front(1, 2, "7", ("North Street", "108"), 95.0),
    front(1, 3, "8", ("Broadway", "1434"), 62.0),
]


def shapes(built: block.Block) -> list[shapely.Polygon]:
    return [shapely.Polygon(outline) for outline in built.outline_m]


def test_only_the_street_with_odd_and_even_numbers_cuts() -> None:
    assert block.cutting_streets([WEST, EAST]) == {"broadway"}


@pytest.mark.parametrize(
    ("here", "there"),
    [
        ("5th Ave", "Fifth Avenue"),
        ("E. 34 St.", "EAST 34TH STREET"),
        ("Grand St", "Grand St"),
    ],
)
def test_a_street_cuts_however_its_two_rings_spell_it(here: str, there: str) -> None:
    def laid(west: str, east: str) -> block.Block:
        rings = [(WEST, west), (EAST, east)]
        fronts = [
            replace(one, street=name) if one.street == "Broadway" else one
            for ring, name in rings
            for one in ring
        ]
        return block.block("9", fronts, [], {})

    mixed, alike = laid(here, there), laid(here, here)
    for one, other in zip(mixed.outline_m, alike.outline_m, strict=True):
        np.testing.assert_array_equal(one, other)
    west, east = shapes(mixed)
    wide_m = address.street_width(there)
    assert west.distance(east) == pytest.approx(wide_m, rel=0.1)


def test_rings_face_each_other_over_the_street_that_cuts_them() -> None:
    west, east = shapes(block.block("9", [*WEST, *EAST], [], {}))
    assert not west.intersects(east)
    assert west.distance(east) == pytest.approx(address.AVENUE_M, rel=0.1)
    assert east.centroid.x > west.centroid.x


@pytest.mark.parametrize("wide_m", [12.0, 44.0])
def test_a_street_that_cuts_is_as_wide_as_it_is_told_to_be(wide_m: float) -> None:
    told = {"broadway": wide_m, "south street": 5.0}
    west, east = shapes(block.block("9", [*WEST, *EAST], [], {}, widths_m=told))
    by_name = block.block("9", [*WEST, *EAST], [], {})
    before = shapes(by_name)[0].distance(shapes(by_name)[1])
    change = west.distance(east) - before
    assert change == pytest.approx(wide_m - address.AVENUE_M, abs=0.5)


def test_the_grid_goes_on_beyond_a_street_that_leans() -> None:
    built = block.block("9", [*WEST, *EAST], [], {})
    for outline in built.outline_m:
        south = outline[1] - outline[0]
        assert south[1] == pytest.approx(0, abs=1e-6)
    west, east = built.outline_m
    broadway, back = west[2] - west[1], east[0] - east[3]
    assert broadway[0] * back[1] == pytest.approx(broadway[1] * back[0], abs=1e-6)
    assert abs(broadway[0]) > 3


def test_rings_that_share_no_street_stand_side_by_side() -> None:
    other = [replace(one, street=f"other {one.side}") for one in EAST]
    west, east = shapes(block.block("9", [*WEST, *other], [], {}))
    assert west.distance(east) >= block.FALLBACK_GAP_M - 1e-6


def test_a_lot_without_a_photo_is_as_high_as_its_neighbours() -> None:
    made, _ = sample.built("1")
    plain, *gaps = [one for one in made.buildings if one.assumed]
    assert plain.building_id == "1-5"
    assert all("-gap-" in one.building_id for one in gaps)
    others = [one.height_m for one in made.buildings if not one.assumed]
    assert min(others) <= plain.height_m <= max(others)


def test_heights_are_those_that_were_painted() -> None:
    made, _ = sample.built("1")
    painted = {
        f"1-{lot}": sample.STOREY_M * storeys for lot, *_, storeys in sample.LOTS
    }
    for one in made.buildings:
        if not one.assumed:
            assert one.height_m == pytest.approx(painted[one.building_id], rel=0.2)


def test_two_facades_give_an_assumed_second_width_its_proportion() -> None:
    fronts = [
        replace(WEST[0], lot="1", width_m=12.0),
        replace(WEST[1], lot="1", width_m=99.0, width_assumed=True),
    ]
    shown = {
        fronts[0].front_id: [Shown(("p", 0), 0.6, 0.01, 0.9)],
        fronts[1].front_id: [Shown(("p", 1), 0.9, 0.01, 0.9)],
    }
    _, second = widths.with_seen_widths(fronts, shown)
    assert second.width_m == pytest.approx(12.0 * 0.9 / 0.6)


def test_a_guessed_width_moves_towards_what_its_photo_makes_likely() -> None:
    guess = replace(WEST[0], width_m=7.6, width_assumed=True)
    wide = {guess.front_id: [Shown(("p", 0), 2.0, 0.02, 0.9)]}
    narrow = {guess.front_id: [Shown(("p", 0), 0.2, 0.02, 0.9)]}
    assert 7.6 < widths.with_seen_widths([guess], wide)[0].width_m < 28.0
    assert 2.8 < widths.with_seen_widths([guess], narrow)[0].width_m < 7.6
    assert widths.with_seen_widths([guess], {})[0].width_m == 7.6


def test_a_block_without_fronts_is_a_mistake() -> None:
    with pytest.raises(ValueError, match="'9' has no fronts"):
        block.block("9", [], [], {})
