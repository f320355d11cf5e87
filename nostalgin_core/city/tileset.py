"""The tiles of blocks in a 3D Tiles 1.1 tileset, and where they lie on the ground.

Every block is a tile with its own transform from its east-north-up frame, so that the
earth's curvature (0.7 m at 3 km) does not tilt it. 3D Tiles' z is up, and glTF content
is turned to it by the reader. Matrices are written column by column.
"""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from jaxtyping import Float

Matrix4 = Float[np.ndarray, "4 4"]
Json = dict[str, Any]
Footprints = Float[np.ndarray, "n 4 2"]
Point = tuple[float, float, float] | Float[np.ndarray, " 3"]

MARGIN_M = 0.01  # float32 positions round outwards by less
# Readers refine where an error covers 16 pixels: then a coarse texel covers four.
ERROR_OF_TEXEL = 4.0


@dataclass(frozen=True, slots=True)
class Place:
    """Where on the globe the local plane touches it: degrees and metres, WGS84."""

    longitude_deg: float
    latitude_deg: float
    height_m: float = 0.0


@dataclass(frozen=True, slots=True)
class Tile:
    """One block's content, its bounds in its own frame and where that frame lies."""

    uri: str
    low_m: tuple[float, float, float]  # east, north, up
    high_m: tuple[float, float, float]
    origin_m: tuple[float, float] = (0.0, 0.0)  # east, north of the city's origin
    place: Place | None = None  # in place of origin_m, where it is known
    turn_rad: float = 0.0  # of its frame against east, anticlockwise
    coarse_uri: str = ""  # the same block with fewer texels; empty: there is none
    coarse_texel_m: float = 0.0  # the largest texel of that one
    footprints_m: Footprints | None = None  # of its buildings, in its own frame
    heights_m: Float[np.ndarray, " n"] | None = None


def ecef_from_enu(place: Place) -> Matrix4:
    """Carry east-north-up metres at a place to the earth-centred frame EPSG:4978."""
    degrees = (place.longitude_deg, place.latitude_deg)
    origin = _to_ecef().transform(*degrees, place.height_m)
    lon, lat = np.radians([place.longitude_deg, place.latitude_deg])
    (sin_lon, sin_lat), (cos_lon, cos_lat) = np.sin([lon, lat]), np.cos([lon, lat])
    east = (-sin_lon, cos_lon, 0.0)
    north = (-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat)
    up = (cos_lat * cos_lon, cos_lat * sin_lon, sin_lat)
    matrix = np.eye(4)
    matrix[:3] = np.column_stack([east, north, up, origin])
    return matrix


def city_from_block(tile: Tile, place: Place | None) -> Matrix4:
    """Carry a block's east-north-up metres to the city's."""
    if tile.place is not None:
        if place is None:
            raise ValueError(f"{tile.uri} has a place on the globe, its city has none")
        there = np.linalg.inv(ecef_from_enu(place)) @ ecef_from_enu(tile.place)
        return there @ _turned(tile.turn_rad)
    matrix = _turned(tile.turn_rad)
    matrix[:2, 3] = tile.origin_m
    return matrix


def box(low_m: Point, high_m: Point) -> list[float]:
    """Write an axis-parallel box as 3D Tiles does: centre and three half axes."""
    low, high = np.asarray(low_m, float), np.asarray(high_m, float)
    return _numbers(
        np.concatenate([(low + high) / 2, np.diag((high - low) / 2).ravel()])
    )


def box_corners(low_m: Point, high_m: Point) -> Float[np.ndarray, "8 3"]:
    """List the eight corners of an axis-parallel box."""
    picks = np.stack(np.meshgrid([0, 1], [0, 1], [0, 1]), axis=-1).reshape(8, 3)
    return np.where(picks == 0, np.asarray(low_m, float), np.asarray(high_m, float))


def carried(
    b_from_a: Matrix4, points_a: Float[np.ndarray, "n 3"]
) -> Float[np.ndarray, "n 3"]:
    """Carry points by an affine map."""
    return points_a @ b_from_a[:3, :3].T + b_from_a[:3, 3]


def leaf(tile: Tile, frame: Matrix4) -> Json:
    """Write one block's tile: its coarse model if it has one, and the fine one below.

    The geometry of both is the same. What is wrong in the coarse one is as wide as its
    largest texel; the error that is told is four texels, so that a reader that allows
    an error of 16 pixels, as most do, takes the fine one where a texel covers four.
    """
    low = np.asarray(tile.low_m, float) - MARGIN_M / 2
    high = np.asarray(tile.high_m, float) + MARGIN_M / 2
    fine: Json = {
        "boundingVolume": {"box": box(low, high)},
        "geometricError": 0.0,
        "content": {"uri": tile.uri},
    }
    if not tile.coarse_uri:
        return {"transform": columns(frame), **fine}
    return {
        "transform": columns(frame),
        "boundingVolume": fine["boundingVolume"],
        "geometricError": round(ERROR_OF_TEXEL * tile.coarse_texel_m, 3),
        "refine": "REPLACE",
        "content": {"uri": tile.coarse_uri},
        "children": [fine],
    }


def _turned(turn_rad: float) -> Matrix4:
    matrix = np.eye(4)
    cos, sin = np.cos(turn_rad), np.sin(turn_rad)
    matrix[:2, :2] = [[cos, -sin], [sin, cos]]
    return matrix


@cache  # making one takes a millisecond, and a city has thousands of blocks
def _to_ecef() -> Any:  # noqa: ANN401 - what is not loaded yet
    from pyproj import Transformer  # noqa: PLC0415 - slow, and no stage needs it

    return Transformer.from_crs("EPSG:4979", "EPSG:4978", always_xy=True)


def columns(matrix: Matrix4) -> list[float]:
    """Write a matrix column by column."""
    return _numbers(matrix.T.ravel())


def _numbers(values: np.ndarray) -> list[float]:
    """Round to a tenth of a nanometre and drop the sign of zero, for equal bytes."""
    return [float(value) + 0.0 for value in np.round(values, 10)]
