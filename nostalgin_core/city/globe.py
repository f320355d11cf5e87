"""From degrees on the globe to metres on a plane, and back.

The plane touches the globe at a city's origin; directions and distances from there are
true (azimuthal equidistant), and others by one in a million ten kilometres away.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any

import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Points
from nostalgin_core.city.plot import Move, Vector, carried
from nostalgin_core.city.tileset import Place

Degrees = Float[np.ndarray, "n 2"]  # longitude, latitude

STEP_M = 100.0  # a way long enough to tell where it leads
DIGITS = 10  # of a degree: hundredths of a millimetre


@dataclass(frozen=True, slots=True)
class Plane:
    """The plane that touches the globe at a place; x is east there, y north."""

    origin: Place

    def metres(self, degrees: Degrees) -> Points:
        """Carry longitudes and latitudes to the plane."""
        to_plane, _ = _transformers(self.origin)
        return np.column_stack(to_plane.transform(*np.asarray(degrees, float).T))

    def degrees(self, points_m: Points) -> Degrees:
        """Carry points of the plane to longitude and latitude."""
        _, to_globe = _transformers(self.origin)
        return np.column_stack(to_globe.transform(*np.asarray(points_m, float).T))


def plane_of(degrees: Degrees) -> Plane:
    """Lay a plane in the middle of places: near most, whatever a few say.

    Raises:
        ValueError: if there are none.
    """
    if not len(degrees):
        raise ValueError("no place, no plane")
    first = degrees[0, 0]
    east = (degrees[:, 0] - first + 180) % 360 - 180  # nothing breaks at 180 degrees
    longitude = (first + np.median(east) + 180) % 360 - 180
    latitude = np.median(degrees[:, 1])
    return Plane(Place(round(float(longitude), 6), round(float(latitude), 6)))


def turn_of(bearing_deg: float, heading_rad: float = 0.0) -> float:
    """Turn a block so that a side of that heading leads where a compass says."""
    return float(np.radians(90.0 - bearing_deg) - heading_rad)


def bearing_of(turn_rad: float, heading_rad: float = 0.0) -> float:
    """Tell where a side leads once its block is turned: degrees from north, 0 to 360.

    Inverse of `turn_of`.
    """
    return float((90.0 - np.degrees(turn_rad + heading_rad)) % 360.0)


def on_globe(plane: Plane, moves: Mapping[str, Move]) -> dict[str, tuple[Place, float]]:
    """Tell where each block's frame lies and how it is turned against east there.

    North is not the same way everywhere: a turn in the plane is another on the spot.
    """
    if not moves:
        return {}
    start, end = np.empty((2, len(moves), 2))
    for index, move in enumerate(moves.values()):
        start[index], end[index] = carried(move, np.array([[0.0, 0.0], [STEP_M, 0.0]]))
    at, to = plane.degrees(start), plane.degrees(end)
    azimuth, _, _ = _wgs84().inv(at[:, 0], at[:, 1], to[:, 0], to[:, 1])
    turns = np.radians(90.0 - np.asarray(azimuth))
    turns = (turns + np.pi) % (2 * np.pi) - np.pi
    placed = [Place(*(float(one) for one in row)) for row in np.round(at, DIGITS)]
    turned = [round(float(turn), DIGITS) for turn in turns]
    return dict(zip(moves, zip(placed, turned, strict=True), strict=True))


def metres_apart(a: Vector, b: Vector) -> float:
    """Measure the shortest way over the globe between two places in degrees."""
    return float(_wgs84().inv(a[0], a[1], b[0], b[1])[2])


@cache
def _wgs84() -> Any:  # noqa: ANN401 - what is not loaded yet
    from pyproj import Geod  # noqa: PLC0415 - slow to load, and no stage needs it

    return Geod(ellps="WGS84")


@lru_cache(maxsize=4)
def _transformers(origin: Place) -> tuple[Any, Any]:
    from pyproj import Transformer  # noqa: PLC0415 - the same

    plane = (
        f"+proj=aeqd +lon_0={origin.longitude_deg} +lat_0={origin.latitude_deg} "
        "+datum=WGS84 +units=m"
    )
    both = [("EPSG:4326", plane), (plane, "EPSG:4326")]
    one, other = (Transformer.from_crs(*pair, always_xy=True) for pair in both)
    return one, other
