"""The ground inside a block's rings on which no building stands: its yards.

Nobody photographed it: it wears the roofs' flat tone, whose evidence is assumed. It
lies at the height of the buildings' floors, and never under one.
"""

from typing import Final

import numpy as np
import shapely

from nostalgin_core.model.atlas import Atlas
from nostalgin_core.records import Block, Mesh

NARROW_M: Final = 0.25  # half as wide is a joint between buildings, no yard
MILLIMETRE: Final = 1e-3


def yards(block: Block, atlas: Atlas) -> Mesh | None:
    """Cover a block's yards with triangles that face up; None where it has none."""
    rings = [shapely.Polygon(one) for one in block.outline_m if len(one) > 2]
    inside = shapely.union_all([shapely.make_valid(one) for one in rings])
    built = shapely.union_all(
        [
            shapely.make_valid(shapely.Polygon(one.footprint_m))
            for one in block.buildings
        ]
    )
    free = shapely.difference(inside, built, grid_size=MILLIMETRE)
    wide = free.buffer(-NARROW_M).buffer(NARROW_M, join_style="mitre")
    parts = shapely.get_parts(
        shapely.constrained_delaunay_triangles(
            shapely.intersection(free, wide, grid_size=MILLIMETRE)
        )
    )
    if not len(parts):
        return None
    corners = [
        shapely.get_coordinates(shapely.orient_polygons(one))[:3] for one in parts
    ]
    flat = np.concatenate(corners)
    h, w = atlas.image.shape
    box = atlas.patches[0]
    tone = np.array([(box.x0 + box.x1) / 2 / w, (box.y0 + box.y1) / 2 / h])
    return Mesh(
        positions_m=np.column_stack([flat, np.zeros(len(flat))]),
        normals=np.tile([0.0, 0.0, 1.0], (len(flat), 1)),
        uvs=np.tile(tone, (len(flat), 1)),
        triangles=np.arange(len(flat), dtype=np.uint32).reshape(-1, 3),
        features=np.zeros(len(flat)),
    )
