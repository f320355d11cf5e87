"""A 3D Tiles 1.1 tileset that places blocks on the ground.

Every block is a tile with its own transform from its east-north-up frame, so that the
earth's curvature (0.7 m at 3 km) does not tilt it. 3D Tiles' z is up, and glTF content
is turned to it by the reader. Matrices are written column by column.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from jaxtyping import Float
from pyproj import Transformer

Matrix4 = Float[np.ndarray, "4 4"]
Json = dict[str, Any]
Point = tuple[float, float, float] | Float[np.ndarray, " 3"]

MARGIN_M = 0.01  # float32 positions round outwards by less


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


def tileset(
    tiles: Sequence[Tile], *, place: Place | None = None, version: str = ""
) -> Json:
    """Describe a city: a root without content, and a leaf a block.

    Without a `place` the root has no transform, and the city lies on a plane at the
    origin. The root's geometric error is the city's diagonal, so that blocks are loaded
    as soon as the whole city covers about sixteen pixels (the usual threshold).

    Raises:
        ValueError: if there is no tile, or if a tile has a place and the city has none.
    """
    if not tiles:
        raise ValueError("a city needs at least one block")
    frames = [city_from_block(tile, place) for tile in tiles]
    corners = np.concatenate(
        [
            carried(frame, box_corners(tile.low_m, tile.high_m))
            for tile, frame in zip(tiles, frames, strict=True)
        ]
    )
    low, high = corners.min(axis=0) - MARGIN_M, corners.max(axis=0) + MARGIN_M
    error = float(np.ceil(np.linalg.norm(high - low)))
    root: Json = {
        "boundingVolume": {"box": box(low, high)},
        "geometricError": error,
        "refine": "ADD",
        "children": [
            _leaf(tile, frame) for tile, frame in zip(tiles, frames, strict=True)
        ],
    }
    if place is not None:
        root["transform"] = _columns(ecef_from_enu(place))
    asset = {"version": "1.1", "generator": "nostalgin"}
    if version:
        asset["tilesetVersion"] = version
    return {"asset": asset, "geometricError": error, "root": root}


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


def _leaf(tile: Tile, frame: Matrix4) -> Json:
    low = np.asarray(tile.low_m, float) - MARGIN_M / 2
    high = np.asarray(tile.high_m, float) + MARGIN_M / 2
    return {
        "transform": _columns(frame),
        "boundingVolume": {"box": box(low, high)},
        "geometricError": 0.0,
        "content": {"uri": tile.uri},
    }


def _turned(turn_rad: float) -> Matrix4:
    matrix = np.eye(4)
    cos, sin = np.cos(turn_rad), np.sin(turn_rad)
    matrix[:2, :2] = [[cos, -sin], [sin, cos]]
    return matrix


@cache  # making one takes a millisecond, and a city has thousands of blocks
def _to_ecef() -> Transformer:
    return Transformer.from_crs("EPSG:4979", "EPSG:4978", always_xy=True)


def _columns(matrix: Matrix4) -> list[float]:
    return _numbers(matrix.T.ravel())


def _numbers(values: np.ndarray) -> list[float]:
    """Round to a tenth of a nanometre and drop the sign of zero, for equal bytes."""
    return [float(value) + 0.0 for value in np.round(values, 10)]
