import numpy as np
import shapely
from shapely import affinity

from nostalgin_core.city.united import DEGREE_M, united

MIDDLE = (-73.986, 40.7555)


def degrees(shape: shapely.Polygon) -> shapely.Polygon:
    east = DEGREE_M * np.cos(np.radians(MIDDLE[1]))
    small = affinity.scale(shape, 1 / east, 1 / DEGREE_M, origin=(0, 0))
    return affinity.translate(small, *MIDDLE)


def area_m2(parts: tuple[np.ndarray, ...]) -> float:
    east = DEGREE_M * np.cos(np.radians(MIDDLE[1]))
    return sum(shapely.Polygon(part).area for part in parts) * east * DEGREE_M


ROW = [degrees(shapely.box(8 * n, 0, 8 * n + 7, 15)) for n in range(10)]


def test_buildings_side_by_side_are_one_outline() -> None:
    (part,) = united(ROW, [""] * len(ROW))
    assert abs(area_m2((part,)) - 79 * 15) < 15
    assert shapely.LinearRing(part).is_ccw


def test_a_street_parts_a_block() -> None:
    far = [degrees(shapely.box(100, 0, 120, 40)), degrees(shapely.box(140, 0, 160, 20))]
    large, small = united(far, ["", ""])
    assert shapely.Polygon(large).area > shapely.Polygon(small).area


def test_a_yard_inside_is_filled() -> None:
    ring = shapely.box(0, 0, 100, 60) - shapely.box(20, 20, 80, 40)
    assert abs(area_m2(united([degrees(ring)], [""])) - 6000) < 10


def test_a_second_sheet_of_the_same_ground_changes_nothing() -> None:
    other = [affinity.translate(one, 2e-5, 1e-5) for one in ROW[:8]]
    twice = united([*ROW, *other], [*["1890"] * 10, *["1857"] * 8])
    (once,) = united(ROW, ["1890"] * 10)
    assert np.allclose(twice[0], once)


def test_a_sheet_that_goes_on_where_another_ends_is_joined() -> None:
    whole = united(ROW, [""] * 10)
    halves = united(ROW, [*["a"] * 5, *["b"] * 5])
    assert np.allclose(whole[0], halves[0])


def test_the_order_of_buildings_changes_nothing() -> None:
    (one,) = united(ROW, [""] * 10)
    (other,) = united([ROW[0], *ROW[:0:-1]], [""] * 10)
    assert np.allclose(one, other, atol=1e-12)


def test_of_nothing_there_is_no_outline() -> None:
    assert united([], []) == ()
