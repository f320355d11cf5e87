"""Where a block's corners lie: on the city's own plane, or on the globe.

On the globe a city is told in metres of the zone of UTM (WGS 84) where its origin lies,
up above the origin's ground. Lengths on that grid are up to 0.04 % short or long.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from pyproj import Transformer

from nostalgin_core.city import Place, ecef_from_enu

Points3 = Float[np.ndarray, "n 3"]
Map = Callable[[Points3], Points3]


@dataclass(frozen=True, slots=True, eq=False)
class Ground:
    """How a block's frame lies."""

    metres: Map  # from the block's frame to metres: of the city's plane, or of UTM
    degrees: Map | None  # to longitude, latitude, metres; None: nobody knows
    epsg: int | None  # of `metres`; None: the city's own plane
    origin_m: tuple[float, float, float]  # of the city, in `metres`


def of_plane(frame: Sequence[float]) -> Ground:
    """Take a city that lies on a plane of its own. `frame` is column by column."""
    matrix = _matrix(frame)
    return Ground(lambda points: _carried(matrix, points), None, None, (0.0, 0.0, 0.0))


def of_globe(frame: Sequence[float], place: Place) -> Ground:
    """Take a city whose origin has a place."""
    matrix = ecef_from_enu(place) @ _matrix(frame)
    zone = min(int((place.longitude_deg + 180.0) // 6.0) + 1, 60)
    epsg = (32600 if place.latitude_deg >= 0 else 32700) + zone
    globe = Transformer.from_crs("EPSG:4978", "EPSG:4979", always_xy=True)
    grid = Transformer.from_crs("EPSG:4326", f"EPSG:{epsg}", always_xy=True)

    def degrees(points: Points3) -> Points3:
        return np.column_stack(globe.transform(*_carried(matrix, points).T))

    def metres(points: Points3) -> Points3:
        lon, lat, up = degrees(points).T
        east, north = grid.transform(lon, lat)
        return np.column_stack([east, north, up - place.height_m])

    east, north = grid.transform(place.longitude_deg, place.latitude_deg)
    return Ground(metres, degrees, epsg, (round(east, 3), round(north, 3), 0.0))


def _matrix(frame: Sequence[float]) -> Float[np.ndarray, "4 4"]:
    return np.array(frame, float).reshape(4, 4).T


def _carried(matrix: Float[np.ndarray, "4 4"], points: Points3) -> Points3:
    return points @ matrix[:3, :3].T + matrix[:3, 3]
