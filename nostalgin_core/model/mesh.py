"""Triangles of a building: its walls, its roof and its floor.

Each wall is a rectangle that shows one tile of the atlas; walls without a photograph,
roofs and floors show a flat patch, lighter or darker by the way they face. A facade is
transparent where the photograph shows no front: above a stepped roof, or where another
building stands before it. So the roof lies at the eaves, where the front is closed from
end to end, and the front rises above it as a parapet; below the eaves a plain wall
stands right behind the facade, so that nobody looks into an empty box. A copy of a
facade is repeated along a longer wall, not stretched.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from jaxtyping import Float

from nostalgin_core import evidence
from nostalgin_core.arrays import Corners
from nostalgin_core.model.atlas import Atlas
from nostalgin_core.records import Box, Building, Mesh, Wall

LIGHT = np.array([-0.6, -0.8])  # the way to a pale sun in the south-west
CLOSED = 0.6  # of a front's width, from which a row of texels counts as closed
LOWEST_EAVES = 0.5  # of the height: below, the photograph misled
BACKING_M = 0.05  # behind the facade: a depth buffer tells them apart at 300 m

Quad3 = Float[np.ndarray, "4 3"]


def building(building: Building, atlas: Atlas, *, number: int = 0) -> Mesh:
    """Enclose one building; every vertex carries the building's number."""
    roof_m = building.height_m * min(
        (eaves(_box(wall, atlas), atlas) for wall in building.walls if wall.texture),
        default=1.0,
    )
    quads: list[Quad3] = []
    boxes: list[Box] = []
    for wall in building.walls:
        box = _box(wall, atlas)
        top_m = building.height_m if wall.texture else roof_m
        for part in _bays(wall, box, building.height_m):
            quads.append(_standing(part, top_m))
            boxes.append(box)
        if wall.texture and gapped(box, atlas):
            quads.append(_standing(wall, roof_m, inset_m=BACKING_M))
            boxes.append(_patch(wall, atlas))
    flat = np.asarray(building.footprint_m, float)
    quads.append(np.column_stack([flat, np.full(4, roof_m)]))
    quads.append(np.column_stack([flat, np.zeros(4)])[::-1])
    boxes += [atlas.patches[0]] * 2
    return _mesh(quads, [_uvs(box, atlas) for box in boxes], number)


def eaves(box: Box, atlas: Atlas) -> float:
    """Tell up to which share of its height a front is closed over most of its width."""
    opacity = atlas.opacity[box.y0 : box.y1, box.x0 : box.x1]
    closed = (opacity > 0).mean(axis=1) >= CLOSED
    top = int(np.argmax(closed)) if closed.any() else 0
    return max(1.0 - top / len(closed), LOWEST_EAVES)


def gapped(box: Box, atlas: Atlas) -> bool:
    """Tell whether any texel of a front is transparent."""
    return bool((atlas.opacity[box.y0 : box.y1, box.x0 : box.x1] == 0).any())


def _mesh(quads: Sequence[Quad3], uvs: Sequence[Corners], number: int) -> Mesh:
    """Cut quads into two triangles each, anticlockwise as they come."""
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


def _bays(wall: Wall, box: Box, height_m: float) -> list[Wall]:
    """Cut a wall that wears a copy into as many parts as the copy goes along it."""
    if wall.evidence != evidence.COPIED:
        return [wall]
    start, end = np.array(wall.start_m), np.array(wall.end_m)
    worn_m = height_m * (box.x1 - box.x0) / (box.y1 - box.y0)
    count = max(1, round(float(np.hypot(*(end - start))) / worn_m))
    marks = [start + (end - start) * n / count for n in range(count + 1)]
    ends = [(float(mark[0]), float(mark[1])) for mark in marks]
    return [replace(wall, start_m=a, end_m=b) for a, b in pairwise(ends)]


def _standing(wall: Wall, height_m: float, *, inset_m: float = 0.0) -> Quad3:
    """Stand a wall up: lower left, lower right, upper right, upper left."""
    start, end = np.array(wall.start_m), np.array(wall.end_m)
    inward = inset_m * _outward(wall)
    (x0, y0), (x1, y1) = start - inward, end - inward
    return np.array(
        [[x0, y0, 0.0], [x1, y1, 0.0], [x1, y1, height_m], [x0, y0, height_m]]
    )


def _outward(wall: Wall) -> Float[np.ndarray, " 2"]:
    ahead = np.subtract(wall.end_m, wall.start_m)
    return np.array([ahead[1], -ahead[0]]) / max(float(np.hypot(*ahead)), 1e-9)


def _box(wall: Wall, atlas: Atlas) -> Box:
    if wall.texture is None:
        return _patch(wall, atlas)
    return atlas.tiles[(*wall.texture, wall.evidence)]


def _patch(wall: Wall, atlas: Atlas) -> Box:
    """Choose a tone: dark for roofs, light for walls that face the light."""
    lit = (1.0 + float(_outward(wall) @ LIGHT)) / 2.0
    return atlas.patches[1 + round(lit * (len(atlas.patches) - 2))]


def _uvs(box: Box, atlas: Atlas) -> Corners:
    h, w = atlas.image.shape
    left, right, top, bottom = box.x0 / w, box.x1 / w, box.y0 / h, box.y1 / h
    return np.array([[left, bottom], [right, bottom], [right, top], [left, top]])


def _normal(quad: Quad3) -> Float[np.ndarray, " 3"]:
    across = np.cross(quad[2] - quad[0], quad[3] - quad[1])
    return across / max(float(np.linalg.norm(across)), 1e-12)
