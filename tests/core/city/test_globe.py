import numpy as np
import pytest
from pyproj import Transformer

from nostalgin_core.city.globe import (
    Plane,
    bearing_of,
    metres_apart,
    on_globe,
    plane_of,
    turn_of,
)
from nostalgin_core.city.plot import Move, carried
from nostalgin_core.city.tileset import Place, ecef_from_enu

MIDTOWN = Place(-73.986, 40.7555)


@pytest.mark.parametrize(
    "origin", [MIDTOWN, Place(0.0, 0.0), Place(179.999, -45.0), Place(13.0, 89.5)]
)
def test_degrees_go_to_metres_and_back(origin: Place) -> None:
    rng = np.random.default_rng(0)
    points = rng.uniform(-20_000, 20_000, (50, 2))
    plane = Plane(origin)
    assert np.allclose(plane.metres(plane.degrees(points)), points, atol=1e-5)


def test_metres_are_metres_and_north_is_up() -> None:
    plane = Plane(MIDTOWN)
    here, east, north = plane.degrees(np.array([[0, 0], [1000.0, 0], [0, 1000.0]]))
    assert metres_apart(here, east) == pytest.approx(1000, abs=1e-3)
    assert metres_apart(here, north) == pytest.approx(1000, abs=1e-3)
    assert north[0] == pytest.approx(here[0], abs=1e-9)
    assert east[0] > here[0]


@pytest.mark.parametrize("bearing", [0.0, 29.0, 119.0, 359.5])
@pytest.mark.parametrize("heading", [0.0, 0.4, -3.0])
def test_bearings_go_to_turns_and_back(bearing: float, heading: float) -> None:
    back = bearing_of(turn_of(bearing, heading), heading)
    assert np.cos(np.radians(back - bearing)) == pytest.approx(1.0, abs=1e-12)


def test_a_side_heading_east_needs_no_turn_to_lead_east() -> None:
    assert turn_of(90.0) == pytest.approx(0.0)
    assert turn_of(0.0) == pytest.approx(np.pi / 2)


def test_a_frame_on_the_globe_is_where_its_plane_has_it() -> None:
    plane = Plane(MIDTOWN)
    move = Move(0.5, 9000.0, 4000.0)
    (place, turn) = on_globe(plane, {"a": move})["a"]
    local = np.array([[0.0, 0.0], [200.0, 50.0]])
    ways = []
    to_ecef = Transformer.from_crs("EPSG:4979", "EPSG:4978", always_xy=True)
    for lon, lat in plane.degrees(carried(move, local)):
        ways.append(to_ecef.transform(lon, lat, 0.0))
    frame = ecef_from_enu(place)
    flat = np.column_stack([carried(Move(turn), local), np.zeros(2)])
    there = flat @ frame[:3, :3].T + frame[:3, 3]
    assert np.allclose(there, ways, atol=0.02)  # the earth bends 3 mm on 200 m
    assert abs(turn - 0.5) > 1e-3  # north is another one 9 km to the east


def test_a_plane_lies_where_most_places_are() -> None:
    near = np.array([[179.99, 10.0], [-179.99, 10.1], [179.98, 9.9], [20.0, 10.0]])
    origin = plane_of(near).origin
    assert abs(abs(origin.longitude_deg) - 180) < 0.05
    assert origin.latitude_deg == pytest.approx(10.0)
