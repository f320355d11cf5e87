"""GLB bytes of one block: a node a building, one atlas, and who the buildings are.

Encoded images pass through untouched. Every building is a node under the block's node;
its vertices carry its row of a property table (EXT_mesh_features,
EXT_structural_metadata), so that a click tells the building. Two material variants show
the photograph and the evidence. Materials are unlit, for the light is in the
photographs, and masked, for blending can't be sorted inside a block. The ground of the
yards hangs on the block's node itself, and is no building's.

The axes are glTF's: (x, y, z) = (east, up, -north), in metres.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from nostalgin_core.model.buffer import (
    ELEMENT_ARRAY_BUFFER,
    Buffer,
    Json,
    accessor,
    container,
    strings,
    vertices,
    view,
)
from nostalgin_core.model.picture import Picture
from nostalgin_core.records import Mesh

Column = Sequence[str] | np.ndarray

NEAREST, LINEAR, LINEAR_MIPMAP_LINEAR, CLAMP_TO_EDGE = 9728, 9729, 9987, 33071
COMPONENTS = {"float32": "FLOAT32", "int32": "INT32", "uint8": "UINT8"}
VARIANTS = ("photograph", "evidence")
GROUND = "-ground"  # after a block's name: its yards


def glb(
    name: str,
    buildings: Sequence[tuple[str, Mesh]],
    *,
    colours: Picture,
    evidence: Picture,
    table: Mapping[str, Column],
    ground: Mesh | None = None,
    copyright: str = "",  # noqa: A002 - glTF's word
    extras: Mapping[str, Any] | None = None,
) -> bytes:
    """Write one block as a binary glTF 2.0 file, the same bytes for the same input.

    `table` has a row a building, in order: strings, or arrays of float32, int32 or
    uint8. `extras` (provenance) goes to `asset.extras`.

    Raises:
        ValueError: if a column of the table has not one row a building, or another
            type.
    """
    _check(table, len(buildings))
    buffer = Buffer()
    meshes = [_mesh(buffer, node, mesh, len(buildings)) for node, mesh in buildings]
    if ground is not None:
        meshes.append(_mesh(buffer, f"{name}{GROUND}", ground, None))
    looks = _looks(buffer, colours, evidence)
    webp = colours.mime == "image/webp"
    extensions = {
        "KHR_materials_variants": {"variants": [{"name": name} for name in VARIANTS]},
        "EXT_structural_metadata": _metadata(buffer, table, len(buildings)),
    }
    used = [*extensions, "KHR_materials_unlit", "EXT_mesh_features"]
    document: Json = {
        "asset": _asset(copyright, extras or {}),
        "extensionsUsed": sorted([*used, *(["EXT_texture_webp"] if webp else [])]),
        **({"extensionsRequired": ["EXT_texture_webp"]} if webp else {}),
        "extensions": extensions,
        "scene": 0,
        "scenes": [{"name": name, "nodes": [0]}],
        "nodes": _nodes(
            name, [node for node, _ in buildings], grounded=ground is not None
        ),
        "meshes": meshes,
        **looks,
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
    }
    return container(document, bytes(buffer.data))


def _check(table: Mapping[str, Column], buildings: int) -> None:
    for column, values in table.items():
        if len(values) != buildings:
            raise ValueError(
                f"column {column!r}: {len(values)} rows, {buildings} buildings"
            )
        if isinstance(values, np.ndarray) and values.dtype.name not in COMPONENTS:
            raise ValueError(
                f"column {column!r}: {values.dtype.name}, not {', '.join(COMPONENTS)}"
            )


def _asset(rights: str, extras: Mapping[str, Any]) -> Json:
    asset: Json = {"version": "2.0", "generator": "nostalgin"}
    if rights:
        asset["copyright"] = rights
    if extras:
        asset["extras"] = dict(extras)
    return asset


def _nodes(block: str, names: Sequence[str], *, grounded: bool) -> list[Json]:
    leaves = [{"name": name, "mesh": index} for index, name in enumerate(names)]
    root: Json = {"name": block, **({"mesh": len(names)} if grounded else {})}
    if leaves:
        root["children"] = list(range(1, len(leaves) + 1))
    return [root, *leaves]


def _mesh(buffer: Buffer, name: str, mesh: Mesh, buildings: int | None) -> Json:
    """Write a mesh; one of no building (None) carries no building's number."""
    east, north, up = mesh.positions_m.T
    across, along, rise = mesh.normals.T
    index_dtype = np.uint16 if len(mesh.positions_m) < 65535 else np.uint32
    attributes = {
        "POSITION": vertices(
            buffer, np.column_stack([east, up, -north]), "VEC3", bounds=True
        ),
        "NORMAL": vertices(buffer, np.column_stack([across, rise, -along]), "VEC3"),
        "TEXCOORD_0": vertices(buffer, mesh.uvs, "VEC2"),
    }
    extensions: Json = {
        "KHR_materials_variants": {
            "mappings": [
                {"material": index, "variants": [index]}
                for index in range(len(VARIANTS))
            ]
        }
    }
    if buildings is not None:
        attributes["_FEATURE_ID_0"] = vertices(buffer, mesh.features, "SCALAR")
        numbered = {"featureCount": buildings, "attribute": 0, "propertyTable": 0}
        extensions["EXT_mesh_features"] = {"featureIds": [numbered]}
    primitive = {
        "attributes": attributes,
        "indices": accessor(
            buffer,
            mesh.triangles.ravel().astype(index_dtype),
            "SCALAR",
            target=ELEMENT_ARRAY_BUFFER,
        ),
        "material": 0,
        "mode": 4,
        "extensions": extensions,
    }
    return {"name": name, "primitives": [primitive]}


def _looks(buffer: Buffer, colours: Picture, evidence: Picture) -> Json:
    """Write both variants: the photograph, filtered, and the evidence, texel by texel.

    A code between two others would be a third one, so evidence is never filtered.
    """
    return {
        "materials": [
            _material(variant, index) for index, variant in enumerate(VARIANTS)
        ],
        "textures": [
            _texture(0, webp=colours.mime == "image/webp"),
            _texture(1, webp=False),
        ],
        "samplers": [
            _sampler(LINEAR, LINEAR_MIPMAP_LINEAR),
            _sampler(NEAREST, NEAREST),
        ],
        "images": [
            _image(buffer, colours, VARIANTS[0]),
            _image(buffer, evidence, VARIANTS[1]),
        ],
    }


def _image(buffer: Buffer, picture: Picture, name: str) -> Json:
    data = view(buffer, picture.data)
    return {"name": name, "bufferView": data, "mimeType": picture.mime}


def _texture(index: int, *, webp: bool) -> Json:
    if webp:
        source = {"EXT_texture_webp": {"source": index}}
        return {"sampler": index, "extensions": source}
    return {"sampler": index, "source": index}


def _sampler(magnified: int, minified: int) -> Json:
    return {
        "magFilter": magnified,
        "minFilter": minified,
        "wrapS": CLAMP_TO_EDGE,
        "wrapT": CLAMP_TO_EDGE,
    }


def _material(name: str, texture: int) -> Json:
    return {
        "name": name,
        "alphaMode": "MASK",
        "alphaCutoff": 0.5,
        "doubleSided": True,  # a parapet is seen from behind too
        "pbrMetallicRoughness": {
            "baseColorTexture": {"index": texture},
            "metallicFactor": 0.0,  # left out it means 1, and facades turn black
            "roughnessFactor": 1.0,
        },
        "extensions": {"KHR_materials_unlit": {}},
    }


def _metadata(buffer: Buffer, table: Mapping[str, Column], count: int) -> Json:
    properties, columns = {}, {}
    for name, values in table.items():
        if isinstance(values, np.ndarray):
            kind = COMPONENTS[values.dtype.name]
            properties[name] = {"type": "SCALAR", "componentType": kind}
            columns[name] = {"values": view(buffer, values.tobytes())}
        else:
            properties[name] = {"type": "STRING"}
            columns[name] = strings(buffer, values)
    return {
        "schema": {
            "id": "nostalgin",
            "classes": {"building": {"properties": properties}},
        },
        "propertyTables": [
            {"class": "building", "count": count, "properties": columns}
        ],
    }
