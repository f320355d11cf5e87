import io
import json
import struct
from functools import cache
from typing import Any

import numpy as np
import pytest
from PIL import Image

from nostalgin_core import evidence
from nostalgin_core.model import atlas, coarse, mesh
from nostalgin_core.model.model import Modelled, model
from nostalgin_core.model.rights import Rights
from tests.core import sample_block as sample

ARCHIVE = Rights("An Archive", "CC BY 4.0", ("https://archive.example/1",))


@cache
def made() -> Modelled:
    return model(sample.settled("1"), sample.elevations("1"), rights=ARCHIVE)


@cache
def pages() -> tuple[atlas.Atlas, atlas.Atlas]:
    wanted = atlas.wanted(sample.settled("1").block)
    fine = atlas.build({key: sample.elevations("1")[key[:2]] for key in wanted})
    return fine, coarse.coarser(fine)


def document(data: bytes) -> dict[str, Any]:
    (length,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + length])


def binary(data: bytes, view: dict[str, Any]) -> bytes:
    (length,) = struct.unpack_from("<I", data, 12)
    start = 28 + length + view["byteOffset"]
    return data[start : start + view["byteLength"]]


def positions(data: bytes) -> list[bytes]:
    told = document(data)
    wanted = [
        told["accessors"][one["primitives"][0]["attributes"]["POSITION"]]
        for one in told["meshes"]
    ]
    return [binary(data, told["bufferViews"][one["bufferView"]]) for one in wanted]


def test_the_model_tells_each_building_s_measures_and_the_rights() -> None:
    told = document(made().glb)
    metadata = told["extensions"]["EXT_structural_metadata"]
    properties = metadata["schema"]["classes"]["building"]["properties"]
    assert {"id", "block", "lot", "address", "assumed", "photo", "credit"} <= set(
        properties
    )
    assert properties["height_m"] == {"type": "SCALAR", "componentType": "FLOAT32"}
    assert told["asset"]["copyright"] == "An Archive; licence: CC BY 4.0"
    extras = told["asset"]["extras"]
    assert (extras["block"], extras["credit"]) == ("1", "An Archive")
    assert (extras["licence"], extras["sources"]) == ("CC BY 4.0", [*ARCHIVE.sources])
    highest = max(one.height_m for one in sample.settled("1").block.buildings)
    assert made().mesh.positions_m[:, 2].max() == pytest.approx(highest)


def test_what_nobody_stated_is_said_too() -> None:
    asset = document(model(sample.settled("1"), sample.elevations("1")).coarse)["asset"]
    assert asset["copyright"] == "credit not stated; licence: not stated"
    assert asset["extras"]["licence"] == "not stated"


def test_the_coarse_model_has_the_fine_one_s_geometry_and_fewer_texels() -> None:
    assert positions(made().coarse) == positions(made().glb)
    assert 3 * len(made().coarse) < len(made().glb)
    fine, small = pages()
    assert small.image.size < fine.image.size / 4


def test_a_coarse_texel_is_as_large_as_its_widest_wall_needs() -> None:
    fine, small = pages()
    one = sample.settled("1").block
    largest = 0.0
    for building in one.buildings:
        for wall in building.walls:
            if wall.texture is not None and wall.evidence is None:
                box = small.tiles[(*wall.texture, None)]
                width = np.hypot(*np.subtract(wall.end_m, wall.start_m))
                largest = max(largest, width / (box.x1 - box.x0))
                largest = max(largest, building.height_m / (box.y1 - box.y0))
    whole = mesh.joined([mesh.building(each, fine) for each in one.buildings])
    far = coarse.carried(whole.uvs, fine, small)
    assert made().coarse_texel_m >= largest - 1e-6
    assert made().coarse_texel_m <= 2 * largest
    assert far.min() >= 0
    assert far.max() <= 1


def test_a_coarse_texel_claims_no_more_than_those_it_is_made_of() -> None:
    fine, small = pages()
    for key, box in small.tiles.items():
        rows, columns = slice(box.y0, box.y1), slice(box.x0, box.x1)
        far = small.evidence[rows, columns] == evidence.PHOTOGRAPHED
        from_box = fine.tiles[key]
        near = fine.evidence[from_box.y0 : from_box.y1, from_box.x0 : from_box.x1]
        sure = (near == evidence.PHOTOGRAPHED).mean()
        assert far.mean() <= sure + 0.01


def test_carrying_coordinates_to_the_same_atlas_changes_nothing() -> None:
    fine, _ = pages()
    one = mesh.building(sample.settled("1").block.buildings[0], fine)
    np.testing.assert_allclose(coarse.carried(one.uvs, fine, fine), one.uvs)


def test_a_coordinate_in_no_tile_is_refused() -> None:
    fine, small = pages()
    with pytest.raises(ValueError, match="lies in no tile"):
        coarse.carried(np.array([[0.0, 0.0]]), fine, small)


def test_without_webp_no_extension_is_required() -> None:
    one = model(sample.settled("1"), sample.elevations("1"), image_format="png")
    for data in (one.glb, one.coarse):
        told = document(data)
        assert "extensionsRequired" not in told
        assert "EXT_texture_webp" not in told["extensionsUsed"]
        colours = binary(data, told["bufferViews"][told["images"][0]["bufferView"]])
        assert Image.open(io.BytesIO(colours)).format == "PNG"


def test_a_block_that_no_photograph_shows_needs_no_coarse_model() -> None:
    fronts = sample.fronts("1")
    bare = sample.Settled(fronts, (), (), sample.raised("1", fronts, (), []))
    one = model(bare, {})
    assert one.coarse == b""
    assert len(one.glb) > 0
