import json
import struct
from dataclasses import replace

import numpy as np
import pytest
import shapely

from nostalgin_core.model.yards import yards
from nostalgin_core.records import Block, Mesh
from tests.core import sample_block as sample

BLOCK = sample.settled("1").block


def covered(ground: Mesh) -> shapely.Geometry:
    triangles = ground.positions_m[ground.triangles][:, :, :2]
    return shapely.union_all([shapely.Polygon(one) for one in triangles])


def built(block: Block) -> shapely.Geometry:
    return shapely.union_all([shapely.Polygon(o.footprint_m) for o in block.buildings])


def test_yards_and_buildings_cover_the_block_once() -> None:
    ground = yards(BLOCK, sample.sheet("1"))
    assert ground is not None
    (outline,) = (shapely.Polygon(one) for one in BLOCK.outline_m)
    houses = built(BLOCK)
    assert ground.positions_m.shape == ground.normals.shape
    assert shapely.area(covered(ground) & houses) < 0.01 * shapely.area(houses)
    assert shapely.area(covered(ground) | houses) == pytest.approx(
        shapely.area(outline | houses), rel=0.01
    )


def test_ground_lies_flat_faces_up_and_is_assumed() -> None:
    ground, sheet = yards(BLOCK, sample.sheet("1")), sample.sheet("1")
    assert ground is not None
    assert not ground.positions_m[:, 2].any()
    a, b, c = ground.positions_m[ground.triangles].swapaxes(0, 1)
    assert (np.cross(b - a, c - a)[:, 2] > 0).all()
    h, w = sheet.image.shape
    codes = {sheet.evidence[int(v * h), int(u * w)] for u, v in ground.uvs}
    assert codes == {6}


def test_a_block_without_a_yard_gets_none() -> None:
    (corner, *_) = BLOCK.buildings
    whole = np.asarray(corner.footprint_m)
    alone = replace(BLOCK, buildings=(corner,), outline_m=(whole,))
    assert yards(alone, sample.sheet("1")) is None
    open_row = replace(alone, outline_m=(whole[:2],))
    assert yards(open_row, sample.sheet("1")) is None


def test_an_outline_that_crosses_itself_has_ground_too() -> None:
    bow = np.array([[0.0, 0.0], [300.0, 200.0], [300.0, 0.0], [0.0, 200.0]])
    ground = yards(replace(BLOCK, outline_m=(bow,)), sample.sheet("1"))
    assert ground is not None
    assert shapely.area(covered(ground) & built(BLOCK)) < 0.01


def test_the_ground_is_no_building_s() -> None:
    _, data = sample.built("1")
    (length,) = struct.unpack_from("<I", data, 12)
    told = json.loads(data[20 : 20 + length])
    root, *leaves = told["nodes"]
    mesh = told["meshes"][root["mesh"]]
    assert mesh["name"] == "1-ground"
    (primitive,) = mesh["primitives"]
    assert "_FEATURE_ID_0" not in primitive["attributes"]
    assert "EXT_mesh_features" not in primitive["extensions"]
    assert len(leaves) == len(BLOCK.buildings)
