"""Buildings that touch make an island between streets, and a point tells whose it is.

Outlines that say of no block are given to the one whose point lies on their island, or
beside it. Sheets of a map are looked at one by one: they show the same ground again.
"""

from collections import defaultdict
from collections.abc import Sequence

import numpy as np
import shapely
from jaxtyping import Float
from shapely.geometry.base import BaseGeometry

from nostalgin_core.city.united import DEGREE_M

TOUCHING_M = 2.0  # twice as far apart is still one island: an alley, no street
ASTRAY_M = 30.0  # a point that lies farther beside an island means none


def islands(
    buildings_deg: Sequence[BaseGeometry],
    sheets: Sequence[str],
    points_deg: Float[np.ndarray, "p 2"],
) -> list[list[int]]:
    """List for each point the buildings of its island, of every sheet, by number."""
    found: list[list[int]] = [[] for _ in points_deg]
    if not buildings_deg or not len(points_deg):
        return found
    scale = DEGREE_M * np.array([np.cos(np.radians(points_deg[0][1])), 1.0])
    own = defaultdict(list)
    for index, sheet in enumerate(sheets):
        own[sheet].append(index)
    spots = shapely.points((points_deg - points_deg[0]) * scale)
    for _, those in sorted(own.items()):
        shapes = [
            shapely.transform(buildings_deg[i], lambda xy: (xy - points_deg[0]) * scale)
            for i in those
        ]
        for point, within in enumerate(_of_sheet(shapes, spots)):
            found[point] += [those[i] for i in within]
    return found


def _of_sheet(shapes: Sequence[BaseGeometry], spots: np.ndarray) -> list[list[int]]:
    grown = shapely.union_all(shapely.buffer(np.array(shapes), TOUCHING_M))
    parts = shapely.get_parts(grown)
    tree = shapely.STRtree(parts)
    inside = shapely.point_on_surface(np.array(shapes))
    members = defaultdict(list)
    for shape, part in tree.query_nearest(inside, all_matches=False).T.tolist():
        members[part].append(shape)
    found: list[list[int]] = [[] for _ in spots]
    near = tree.query_nearest(spots, max_distance=ASTRAY_M, all_matches=False)
    for point, part in near.T.tolist():
        found[point] = members[part]
    return found
