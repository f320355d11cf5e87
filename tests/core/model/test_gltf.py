import io
import json
import os
import shutil
import struct
import subprocess
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from nostalgin_core.model import gltf, mesh, picture
from nostalgin_core.model.picture import Picture
from nostalgin_core.records import Block
from tests.core import sample_block as sample
from tests.data import ROOT

MODULES = Path(os.environ.get("NOSTALGIN_NODE_MODULES", ROOT / "viewer/node_modules"))
VALIDATE = """
const { createRequire } = require("node:module");
const { readFileSync } = require("node:fs");
const validator = createRequire(process.argv[1] + "/")("gltf-validator");
validator.validateBytes(new Uint8Array(readFileSync(0)))
  .then((report) => console.log(JSON.stringify(report)));
"""
needs_validator = pytest.mark.skipif(
    shutil.which("node") is None or not (MODULES / "gltf-validator").is_dir(),
    reason=f"no gltf-validator in {MODULES}: npm install there, or set "
    "NOSTALGIN_NODE_MODULES",
)


@pytest.fixture(scope="module")
def block() -> tuple[Block, bytes]:
    return sample.built("1")


def parts(data: bytes) -> tuple[dict[str, Any], bytes]:
    (length,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + length]), data[28 + length :]


def view(data: bytes, index: int) -> bytes:
    document, binary = parts(data)
    one = document["bufferViews"][index]
    return binary[one["byteOffset"] : one["byteOffset"] + one["byteLength"]]


def written(image_format: picture.ImageFormat = "webp") -> bytes:
    """Write the sample with both images, and a table with every kind of column."""
    made, _ = sample.built("1")
    sheet = sample.sheet("1")
    meshes = [
        (one.building_id, mesh.building(one, sheet, number=number))
        for number, one in enumerate(made.buildings)
    ]
    return gltf.glb(
        "1",
        meshes,
        colours=picture.colours(sheet, image_format=image_format),
        evidence=picture.evidence_key(sheet),
        table=sample.known("1"),
        copyright="nobody",
        extras={"run": "r"},
    )


def report(data: bytes) -> dict[str, Any]:
    command = ["node", "-e", VALIDATE, str(MODULES)]
    done = subprocess.run(command, input=data, capture_output=True, check=True)
    return json.loads(done.stdout)


@needs_validator
@pytest.mark.parametrize("image_format", ["webp", "png"])
def test_the_khronos_validator_finds_no_error_and_no_warning(
    image_format: picture.ImageFormat,
) -> None:
    issues = report(written(image_format))["issues"]
    assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues["messages"]


@needs_validator
def test_the_validator_can_fail() -> None:
    data = written().replace(b'"version":"2.0"', b'"version":"9.9"')
    assert report(data)["issues"]["numErrors"] > 0


def test_a_second_reader_finds_every_building_where_it_stands(
    block: tuple[Block, bytes],
) -> None:
    made, data = block
    scene = trimesh.load(io.BytesIO(data), file_type="glb")
    names = {one.building_id for one in made.buildings}
    assert set(scene.geometry) == names | {"1-ground"}
    for one in made.buildings:
        low, high = scene.geometry[one.building_id].bounds
        east, north = one.footprint_m.T
        np.testing.assert_allclose(
            [low[0], high[0]], [east.min(), east.max()], atol=1e-4
        )
        np.testing.assert_allclose(
            [low[2], high[2]], [-north.max(), -north.min()], atol=1e-4
        )
        assert low[1] == 0
        assert high[1] == pytest.approx(one.height_m, rel=1e-5)


def test_nodes_stand_in_the_order_of_the_ring(block: tuple[Block, bytes]) -> None:
    made, data = block
    document, _ = parts(data)
    names = [
        document["nodes"][child]["name"] for child in document["nodes"][0]["children"]
    ]
    assert names == [one.building_id for one in made.buildings]


def test_lengths_are_what_they_say_and_multiples_of_eight(
    block: tuple[Block, bytes],
) -> None:
    data = block[1]
    document, binary = parts(data)
    assert struct.unpack_from("<I", data, 8) == (len(data),)
    assert len(data) % 8 == 0
    assert document["buffers"] == [{"byteLength": len(binary)}]
    assert all(one["byteOffset"] % 8 == 0 for one in document["bufferViews"])


def test_encoded_images_pass_through_untouched() -> None:
    colours, key = Picture(b"any bytes", "image/webp"), Picture(b"others", "image/png")
    data = gltf.glb("1", [], colours=colours, evidence=key, table={})
    views = [image["bufferView"] for image in parts(data)[0]["images"]]
    assert [view(data, index) for index in views] == [b"any bytes", b"others"]


def test_materials_are_as_facades_need_them(block: tuple[Block, bytes]) -> None:
    document, _ = parts(block[1])
    for material in document["materials"]:
        assert material["alphaMode"] == "MASK"
        assert material["pbrMetallicRoughness"]["metallicFactor"] == 0
        assert "KHR_materials_unlit" in material["extensions"]
    wraps = {one[axis] for one in document["samplers"] for axis in ("wrapS", "wrapT")}
    assert wraps == {gltf.CLAMP_TO_EDGE}
    assert document["samplers"][1]["minFilter"] == gltf.NEAREST


def test_both_variants_share_texture_coordinates(block: tuple[Block, bytes]) -> None:
    document, _ = parts(block[1])
    names = document["extensions"]["KHR_materials_variants"]["variants"]
    assert [one["name"] for one in names] == ["photograph", "evidence"]
    for one in document["materials"]:
        assert "texCoord" not in one["pbrMetallicRoughness"]["baseColorTexture"]


def strings(data: bytes, column: str) -> list[str]:
    metadata = parts(data)[0]["extensions"]["EXT_structural_metadata"]
    stored = metadata["propertyTables"][0]["properties"][column]
    offsets = np.frombuffer(view(data, stored["stringOffsets"]), np.uint32)
    text = view(data, stored["values"])
    return [text[a:b].decode() for a, b in pairwise(offsets)]


def test_a_vertex_tells_its_building_through_the_property_table(
    block: tuple[Block, bytes],
) -> None:
    made, data = block
    document, _ = parts(data)
    ids = strings(data, "id")
    assert ids == [one.building_id for one in made.buildings]
    *houses, _ = document["meshes"]  # the last is the ground
    for one in houses:
        accessor = document["accessors"][
            one["primitives"][0]["attributes"]["_FEATURE_ID_0"]
        ]
        numbers = np.frombuffer(view(data, accessor["bufferView"]), np.float32)
        assert {ids[int(number)] for number in numbers} == {one["name"]}


def test_words_of_any_alphabet_survive_in_the_table() -> None:
    blank = Picture(b"x", "image/png")
    one = (sample.built("1")[0].buildings[0].building_id, sample.any_mesh())
    words = {"address": ["Straße 5½, 東"], "empty": [""]}
    data = gltf.glb("1", [one], colours=blank, evidence=blank, table=words)
    assert strings(data, "address") == words["address"]
    assert strings(data, "empty") == [""]


def test_the_same_block_gives_the_same_bytes(block: tuple[Block, bytes]) -> None:
    assert sample.rebuilt("1")[1] == block[1]


def test_a_short_column_is_refused() -> None:
    blank = Picture(b"x", "image/png")
    with pytest.raises(ValueError, match="'lot'"):
        gltf.glb("1", [], colours=blank, evidence=blank, table={"lot": ["1"]})


def test_a_column_of_another_type_is_refused() -> None:
    blank = Picture(b"x", "image/png")
    table = {"height": np.zeros(0, np.float64)}
    with pytest.raises(ValueError, match="'height': float64"):
        gltf.glb("1", [], colours=blank, evidence=blank, table=table)
