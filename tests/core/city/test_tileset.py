import json
from typing import Any

import numpy as np
import pytest
from pyproj import Geod, Transformer

from nostalgin_core.city.tileset import (
    Place,
    Tile,
    carried,
    ecef_from_enu,
)
from nostalgin_core.city.tree import tree
from tests.core import sample_block as sample

MIDTOWN = Place(-73.9868, 40.7549, 12.0)
LOCAL = [
    Tile("blocks/1.glb", (0.0, 0.0, 0.0), (60.0, 40.0, 80.0)),
    Tile("blocks/2.glb", (-5.0, 0.0, 0.0), (60.0, 45.0, 20.0), origin_m=(0.0, 90.0)),
]
PLACED = [
    Tile("a.glb", (0.0, 0.0, 0.0), (60.0, 40.0, 80.0), place=MIDTOWN),
    Tile("b.glb", (0.0, 0.0, 0.0), (60.0, 40.0, 30.0), place=Place(-73.98, 40.76)),
    Tile("c.glb", (0.0, 0.0, 0.0), (60.0, 40.0, 30.0), place=Place(-74.1, 40.6)),
]


def matrix(tile: dict[str, Any]) -> np.ndarray:
    """Read a transform as 3D Tiles stores it, column by column."""
    return np.array(tile.get("transform", np.eye(4).ravel())).reshape(4, 4).T


def corners(tile: dict[str, Any]) -> np.ndarray:
    box = np.array(tile["boundingVolume"]["box"])
    centre, axes = box[:3], box[3:].reshape(3, 3)
    signs = np.stack(np.meshgrid([-1, 1], [-1, 1], [-1, 1]), -1).reshape(8, 3)
    return centre + signs @ axes


def outside(points: np.ndarray, tile: dict[str, Any]) -> float:
    """Measure by how much points stick out of a tile's box; negative when inside."""
    box = np.array(tile["boundingVolume"]["box"])
    axes = box[3:].reshape(3, 3)
    halves = np.linalg.norm(axes, axis=1)
    along = np.abs((points - box[:3]) @ (axes / halves[:, None]).T)
    return float((along - halves).max())


@pytest.mark.parametrize(("tiles", "place"), [(LOCAL, None), (PLACED, MIDTOWN)])
def test_children_lie_inside_their_parent(
    tiles: list[Tile], place: Place | None
) -> None:
    root = tree(tiles, place=place).tileset["root"]
    for child in root["children"]:
        inside = carried(matrix(child), corners(child))
        assert outside(inside, root) <= 1e-6


def test_content_lies_inside_its_tile() -> None:
    made, _ = sample.built("1")
    low, high = sample.bounds(made)
    tile = tree([Tile("1.glb", low, high)]).tileset["root"]["children"][0]
    ground = np.concatenate([one.footprint_m for one in made.buildings])
    tops = np.repeat([one.height_m for one in made.buildings], 4)
    content = np.vstack(
        [np.column_stack([ground, up]) for up in (np.zeros(len(ground)), tops)]
    )
    assert outside(content.astype(np.float32), tile) <= 0


def test_the_containment_check_can_fail() -> None:
    root = tree(LOCAL).tileset["root"]
    root["boundingVolume"]["box"][3] -= 1.0
    assert outside(corners(root["children"][0]), root) > 0.5


def test_a_place_is_where_the_globe_says() -> None:
    to_globe = Transformer.from_crs("EPSG:4978", "EPSG:4979", always_xy=True)
    frame = ecef_from_enu(MIDTOWN)
    east_m, north_m, up_m = 300.0, -200.0, 7.0
    lon, lat, height = to_globe.transform(*(frame @ [east_m, north_m, up_m, 1.0])[:3])
    azimuth, _, distance = Geod(ellps="WGS84").inv(
        MIDTOWN.longitude_deg, MIDTOWN.latitude_deg, lon, lat
    )
    assert distance == pytest.approx(np.hypot(east_m, north_m), abs=0.02)
    assert azimuth == pytest.approx(np.degrees(np.arctan2(east_m, north_m)), abs=0.02)
    assert height - MIDTOWN.height_m == pytest.approx(up_m, abs=0.02)


def test_a_block_s_own_place_wins_over_the_city_s_plane() -> None:
    far = tree(PLACED, place=MIDTOWN).tileset["root"]["children"][2]
    frame = ecef_from_enu(MIDTOWN) @ matrix(far)
    np.testing.assert_allclose(frame, ecef_from_enu(Place(-74.1, 40.6)), atol=1e-6)
    assert matrix(far)[2, 3] < -10  # the earth curves away below the plane


def test_a_city_without_a_place_lies_at_the_origin() -> None:
    root = tree(LOCAL).tileset["root"]
    assert "transform" not in root
    np.testing.assert_allclose(matrix(root["children"][1])[:3, 3], [0, 90, 0])


def test_it_is_3d_tiles_1_1_and_writes_as_plain_json() -> None:
    city = tree(PLACED, place=MIDTOWN, version="7").tileset
    assert city["asset"]["version"] == "1.1"
    assert json.loads(json.dumps(city, allow_nan=False)) == city
    assert city["geometricError"] >= city["root"]["geometricError"] > 0
    assert [one["content"]["uri"] for one in city["root"]["children"]] == [
        "a.glb",
        "b.glb",
        "c.glb",
    ]


def test_a_city_without_blocks_is_refused() -> None:
    with pytest.raises(ValueError, match="at least one block"):
        tree([])


def test_a_block_on_the_globe_needs_a_city_on_the_globe() -> None:
    with pytest.raises(ValueError, match="its city has none"):
        tree(PLACED)
