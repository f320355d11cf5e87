"""Triangles of a building: its walls, its roof and its floor, closed.

Each wall is a rectangle that shows one tile of the atlas; walls without a photograph,
roofs and floors show a flat patch, lighter or darker by the way they face.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Corners
from nostalgin_core.atlas import Atlas
from nostalgin_core.records import Box, Building, Mesh, Wall

LIGHT = np.array([-0.6, -0.8])  # the way to a pale sun in the south-west

Quad3 = Float[np.ndarray, "4 3"]


def building(building: Building, atlas: Atlas, *, number: int = 0) -> Mesh:
    """Enclose one building; every vertex carries the building's number."""
    quads = [_standing(wall, building.height_m) for wall in building.walls]
    uvs = [_uvs(_box(wall, atlas), atlas) for wall in building.walls]
    flat = np.asarray(building.footprint_m, float)
    roof = np.column_stack([flat, np.full(4, building.height_m)])
    floor = np.column_stack([flat, np.zeros(4)])[::-1]
    quads += [roof, floor]
    uvs += [_uvs(atlas.patches[0], atlas)] * 2
    normals = [np.repeat(_normal(quad)[None], 4, axis=0) for quad in quads]
    first = 4 * np.arange(len(quads), dtype=np.uint32)[:, None]
    corners = np.array([0, 1, 2, 0, 2, 3], np.uint32)
    return Mesh(
        positions_m=np.concatenate(quads),
        normals=np.concatenate(normals),
        uvs=np.concatenate(uvs),
        triangles=(first + corners).reshape(-1, 3),
        features=np.full(4 * len(quads), float(number)),
    )


def joined(meshes: Sequence[Mesh]) -> Mesh:
    """Put several meshes into one, in order."""
    starts = np.cumsum([0] + [len(mesh.positions_m) for mesh in meshes[:-1]])
    return Mesh(
        positions_m=np.concatenate([mesh.positions_m for mesh in meshes]),
        normals=np.concatenate([mesh.normals for mesh in meshes]),
        uvs=np.concatenate([mesh.uvs for mesh in meshes]),
        triangles=np.concatenate(
            [
                mesh.triangles + np.uint32(start)
                for mesh, start in zip(meshes, starts, strict=True)
            ]
        ),
        features=np.concatenate([mesh.features for mesh in meshes]),
    )


def _standing(wall: Wall, height_m: float) -> Quad3:
    """Stand a wall up: lower left, lower right, upper right, upper left."""
    (x0, y0), (x1, y1) = wall.start_m, wall.end_m
    return np.array(
        [[x0, y0, 0.0], [x1, y1, 0.0], [x1, y1, height_m], [x0, y0, height_m]]
    )


def _box(wall: Wall, atlas: Atlas) -> Box:
    if wall.texture is not None:
        return atlas.tiles[(*wall.texture, wall.evidence)]
    ahead = np.subtract(wall.end_m, wall.start_m)
    outward = np.array([ahead[1], -ahead[0]]) / max(float(np.hypot(*ahead)), 1e-9)
    lit = (1.0 + float(outward @ LIGHT)) / 2.0
    return atlas.patches[1 + round(lit * (len(atlas.patches) - 2))]


def _uvs(box: Box, atlas: Atlas) -> Corners:
    h, w = atlas.image.shape
    left, right, top, bottom = box.x0 / w, box.x1 / w, box.y0 / h, box.y1 / h
    return np.array([[left, bottom], [right, bottom], [right, top], [left, top]])


def _normal(quad: Quad3) -> Float[np.ndarray, " 3"]:
    across = np.cross(quad[2] - quad[0], quad[3] - quad[1])
    return across / max(float(np.linalg.norm(across)), 1e-12)
