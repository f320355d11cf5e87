import numpy as np
import pytest

from nostalgin_core.city import city
from nostalgin_core.city.anchor import (
    Anchor,
    Settled,
    anchored,
    gap_m,
    overlaps,
    streets,
)
from nostalgin_core.city.globe import Plane
from nostalgin_core.city.plot import Border, Move, Plot, carried, centre, moved
from nostalgin_core.city.tileset import Place

PLANE = Plane(Place(-73.986, 40.7555))
TURN = np.radians(-29.0)
CORNERS = np.array([[0.0, 0.0], [240.0, 0.0], [265.0, 61.0], [25.0, 61.0]])


def town(wide_m: float = 18.3) -> tuple[list[Plot], dict[str, Move]]:
    """Stack five slanted blocks between numbered streets, turned as midtown is."""
    plots, true = [], {}
    for row in range(5):
        streets = (f"{row} street", "6 avenue", f"{row + 1} street", "broadway")
        y = 40 * row
        numbers = ((101, 165), (y + 1, y + 21), (166, 102), (y + 22, y + 2))
        borders = tuple(
            Border(
                streets[at],
                streets[at - 1],
                streets[(at + 1) % 4],
                CORNERS[at],
                CORNERS[(at + 1) % 4],
                numbers[at],
            )
            for at in range(4)
        )
        plots.append(Plot(str(row), (CORNERS,), borders))
        there = carried(Move(TURN), np.array([[25.0 * row, row * (61 + wide_m)]]))[0]
        true[str(row)] = Move(TURN, float(there[0]), float(there[1]))
    return plots, true


def outline(move: Move) -> Anchor:
    ring = PLANE.degrees(carried(move, CORNERS))
    lon, lat = ring.mean(axis=0)
    return Anchor(float(lon), float(lat), outline_deg=(ring,))


def point(one: Plot, move: Move, bearing: float | None = None) -> Anchor:
    lon, lat = PLANE.degrees(centre(moved(one, move))[None])[0]
    return Anchor(float(lon), float(lat), bearing)


def off(found: Settled, true: dict[str, Move], block: str) -> float:
    """Tell how far the corners of a block lie from the truth, over the globe."""
    assert found.plane is not None
    there = found.plane.degrees(carried(found.moves[block], CORNERS))
    return float(
        np.hypot(*(PLANE.metres(there) - carried(true[block], CORNERS)).T).max()
    )


def test_blocks_lie_in_their_outlines_the_right_way_round() -> None:
    plots, true = town(30.0)
    anchors = {one.block: outline(true[one.block]) for one in plots}
    found = anchored(plots, anchors)
    assert max(off(found, true, one.block) for one in plots) < 0.05
    assert {one.how for one in found.told.values()} == {"outline"}
    assert not any(one.note for one in found.told.values())


def test_streets_are_as_wide_as_outlines_leave_them_and_others_take_it_over() -> None:
    plots, true = town(30.0)
    given = {one.block: true[one.block] for one in plots}
    assert streets(plots, given) == pytest.approx(
        {f"{n} street": 30.0 for n in (1, 2, 3, 4)}
    )
    anchors = {str(n): outline(true[str(n)]) for n in (0, 1)}
    found = anchored(plots, anchors)
    assert found.widths_m == pytest.approx({"1 street": 30.0}, abs=0.05)


def test_points_turn_blocks_as_their_neighbours_lie() -> None:
    plots, true = town()
    anchors = {one.block: point(one, true[one.block]) for one in plots}
    found = anchored(plots, anchors)
    assert max(off(found, true, one.block) for one in plots) < 1.0


def test_one_wrong_point_turns_no_other_block() -> None:
    plots, true = town()
    anchors = {one.block: point(one, true[one.block]) for one in plots}
    wrong = anchors["2"]
    anchors["2"] = Anchor(wrong.longitude_deg + 0.01, wrong.latitude_deg)
    found = anchored(plots, anchors)
    for name in ("0", "1", "3", "4"):
        assert off(found, true, name) < 8.0


def test_one_place_and_bearing_places_a_whole_city() -> None:
    plots, true = town()
    found = anchored(plots, {"0": point(plots[0], true["0"], 90.0 + 29.0)})
    assert max(off(found, true, one.block) for one in plots) < 0.05
    assert [found.told[one.block].how for one in plots] == ["point"] + 4 * ["streets"]


def test_a_place_without_a_bearing_says_what_is_missing() -> None:
    plots, true = town()
    found = anchored(plots[:1], {"0": point(plots[0], true["0"])})
    assert "bearing" in found.told["0"].note


def test_turning_all_outlines_turns_the_city() -> None:
    plots, true = town()
    turned = {
        block: Move(
            move.turn_rad + 2.0,
            *carried(Move(2.0), np.array([[move.east_m, move.north_m]]))[0].tolist(),
        )
        for block, move in true.items()
    }
    anchors = {one.block: outline(turned[one.block]) for one in plots}
    found = anchored(plots, anchors)
    assert max(off(found, turned, one.block) for one in plots) < 0.05


def test_a_block_of_another_city_goes_on_by_its_streets() -> None:
    plots, true = town()
    anchors = {one.block: outline(true[one.block]) for one in plots}
    anchors["3"] = Anchor(2.35, 48.85)
    found = anchored(plots, anchors)
    assert "km from the others" in found.told["3"].note
    assert found.told["3"].how == "streets"
    assert off(found, true, "3") < 0.1


def test_an_outline_of_another_size_goes_on_by_its_streets() -> None:
    plots, true = town()
    anchors = {one.block: outline(true[one.block]) for one in plots}
    (ring,) = anchors["1"].outline_deg
    small = ring.mean(axis=0) + 0.3048 * (ring - ring.mean(axis=0))
    anchors["1"] = Anchor(*ring.mean(axis=0).tolist(), outline_deg=(small,))
    found = anchored(plots, anchors)
    assert "times the size" in found.told["1"].note
    assert off(found, true, "1") < 0.1


def test_without_anchors_blocks_stand_as_by_streets_alone() -> None:
    plots, _ = town()
    found = anchored(plots, {})
    assert found.moves == city.places(plots)
    assert found.plane is None


def test_blocks_on_one_another_are_told() -> None:
    plots, true = town()
    assert overlaps(plots, true) == []
    true["1"] = true["0"]
    ((a, b, area),) = overlaps(plots, true)
    assert (a, b) == ("0", "1")
    assert area == pytest.approx(61 * 240)


def test_the_street_inside_a_block_is_what_lies_between_its_outlines_two_parts() -> (
    None
):
    scale = 1 / 111_320.0
    square = np.array([[0, 0], [60, 0], [60, 50], [0, 50]]) * scale
    beyond = square + np.array([91.0, 0]) * scale
    gap = gap_m(Anchor(0.0, 0.0, outline_deg=(square, beyond)))
    assert gap == pytest.approx(31.0, rel=0.01)
    assert gap_m(Anchor(0.0, 0.0, outline_deg=(square,))) is None
    touching = square + np.array([60.0, 0]) * scale
    assert gap_m(Anchor(0.0, 0.0, outline_deg=(square, touching))) is None
