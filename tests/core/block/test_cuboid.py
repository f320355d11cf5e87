from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nostalgin_core import evidence
from nostalgin_core.block import cuboid, heights
from nostalgin_core.block.chain import Footprint
from nostalgin_core.block.heights import Shown

CORNERS = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 6.0], [0.0, 6.0]])
PLAIN = Footprint("9-a", CORNERS, ("f", None, None, None), 0)
CORNER = Footprint("9-b", CORNERS, ("f", "g", None, None), 1)


def shown(
    aspect: float, *, sd: float = 0.02, score: float = 0.9, photo: str = "p"
) -> Shown:
    return Shown((photo, 0), aspect, sd * aspect, score)


def high(footprint: Footprint, views: dict[str, list[Shown]]) -> float:
    """Tell how high a building is that so much is shown of."""
    known = heights.height(cuboid.told(footprint, views))
    assert known is not None
    return cuboid.cuboid(footprint, views, known).height_m


@settings(deadline=None)  # a busy machine is no failure
@given(st.floats(0.3, 1.0))
def test_a_wall_is_as_high_as_its_elevation_says(aspect: float) -> None:
    assert high(PLAIN, {"f": [shown(aspect)]}) == pytest.approx(10 / aspect, rel=0.1)


def test_both_facades_of_a_corner_agree_on_the_height() -> None:
    views = {"f": [shown(0.5)], "g": [shown(0.3)]}
    assert high(CORNER, views) == pytest.approx(20.0, rel=0.02)


def test_one_bad_quad_among_three_moves_little() -> None:
    views = [shown(0.5), shown(0.5), shown(4.0, score=0.9)]
    assert high(PLAIN, {"f": views}) == pytest.approx(20.0, rel=0.05)


def test_an_elevation_known_well_outweighs_a_vague_one() -> None:
    views = [shown(0.5, sd=0.02), shown(0.2, sd=0.3)]
    assert high(PLAIN, {"f": views}) == pytest.approx(20.0, rel=0.1)


@pytest.mark.parametrize("aspect", [10.0, 0.01])
def test_a_height_that_no_house_has_is_not_believed(aspect: float) -> None:
    views = {"f": [shown(aspect)]}
    assert cuboid.told(PLAIN, views) == []
    built = cuboid.cuboid(PLAIN, views, assumed_m=13.0)
    assert built.assumed
    assert built.height_m == 13.0


def test_a_lot_without_a_photo_is_a_plain_volume_marked_as_assumed() -> None:
    built = cuboid.cuboid(PLAIN, {})
    assert built.assumed
    assert all(wall.texture is None for wall in built.walls)
    assert {wall.evidence for wall in built.walls} == {evidence.ASSUMED}


def test_a_front_wears_the_best_of_its_photos() -> None:
    views = [shown(0.5, score=0.4, photo="p"), shown(0.5, score=0.8, photo="q")]
    assert cuboid.cuboid(PLAIN, {"f": views}).walls[0].texture == ("q", 0)


def test_a_second_front_without_a_photo_wears_a_copy_and_says_so() -> None:
    walls = cuboid.cuboid(CORNER, {"f": [shown(0.5)]}).walls
    assert [wall.evidence for wall in walls] == [
        None,
        evidence.COPIED,
        evidence.ASSUMED,
        evidence.ASSUMED,
    ]


def test_copies_go_round_all_sides_if_asked() -> None:
    walls = cuboid.cuboid(PLAIN, {"f": [shown(0.5)]}, copied=True).walls
    assert [wall.evidence for wall in walls] == [None, *[evidence.COPIED] * 3]
    assert {wall.texture for wall in walls} == {("p", 0)}


def test_walls_follow_the_footprint_round() -> None:
    walls = cuboid.cuboid(PLAIN, {}).walls
    for edge, wall in enumerate(walls):
        assert wall.start_m == tuple(CORNERS[edge])
        assert wall.end_m == tuple(CORNERS[(edge + 1) % 4])


def test_a_corner_wall_on_a_street_wears_a_copy_though_it_is_no_known_front() -> None:
    silent = replace(CORNER, front_ids=("f", None, None, None))
    walls = cuboid.cuboid(silent, {"f": [shown(0.5)]}).walls
    assert [wall.evidence for wall in walls[:3]] == [
        None,
        evidence.COPIED,
        evidence.ASSUMED,
    ]


def test_an_elevation_that_is_mostly_invented_gives_way_to_the_next_best() -> None:
    invented = replace(shown(1.0, photo="invented"), clear=0.2)
    worse = shown(1.0, score=0.3, photo="seen")
    both = cuboid.cuboid(PLAIN, {"f": [invented, worse]})
    assert both.walls[0].texture == ("seen", 0)
    alone = cuboid.cuboid(PLAIN, {"f": [invented]})
    assert alone.walls[0].texture is None
    assert alone.walls[0].evidence == evidence.ASSUMED


def test_at_a_corner_it_gives_way_to_a_copy_of_the_other_front() -> None:
    invented = replace(shown(1.0, photo="invented"), clear=0.2)
    made = cuboid.cuboid(CORNER, {"f": [invented], "g": [shown(1.0)]})
    assert made.walls[0].texture == ("p", 0)
    assert made.walls[0].evidence == evidence.COPIED
