"""The outlines of a block's buildings become the outline of the block.

What lies closer together than a street is wide is joined: outlines are grown, united
and shrunk again. Yards inside are filled. Maps drawn in several sheets, or at several
times, show a building more than once: of sheets that cover one another, the one that
shows most counts, and others add only what it does not show.
"""

from collections.abc import Sequence

import numpy as np
import shapely
from jaxtyping import Float
from shapely.geometry.base import BaseGeometry

Part = Float[np.ndarray, "_ 2"]  # longitude, latitude; one ring

CLOSE_M = 6.0  # twice as far apart is still one block; few streets are narrower
COVERED = 0.3  # of a sheet: beyond, it shows what another shows already
LEAST = 0.1  # of the largest part: less is a shed beyond a street
PLAIN_M = 0.3  # by so much an outline may be drawn simpler
DEGREE_M = 111_320.0  # of latitude, nearly


def united(
    buildings_deg: Sequence[BaseGeometry], sheets: Sequence[str]
) -> tuple[Part, ...]:
    """Unite the polygons of one block, each of a sheet; the largest part comes first.

    Polygons are valid, in degrees; what comes out are rings without their last point,
    anticlockwise. There is none where no ground is covered.
    """
    if not buildings_deg:
        return ()
    middle = shapely.get_coordinates(buildings_deg[0])[0]
    scale = DEGREE_M * np.array([np.cos(np.radians(middle[1])), 1.0])
    flat = [
        shapely.transform(b, lambda xy: (xy - middle) * scale) for b in buildings_deg
    ]
    grown = _sheeted(flat, sheets).buffer(CLOSE_M, join_style="mitre")
    closed = shapely.simplify(grown.buffer(-CLOSE_M, join_style="mitre"), PLAIN_M)
    shapes = [shapely.Polygon(_exterior(one)) for one in _polygons(closed)]
    shapes.sort(key=lambda one: (-one.area, one.bounds))
    kept = [one for one in shapes if one.area > max(1.0, LEAST * shapes[0].area)]
    rings = [_exterior(shapely.normalize(one))[:0:-1] for one in kept]
    return tuple(ring / scale + middle for ring in rings)


def _sheeted(shapes: Sequence[BaseGeometry], sheets: Sequence[str]) -> BaseGeometry:
    by_sheet: dict[str, list[BaseGeometry]] = {}
    for shape, sheet in zip(shapes, sheets, strict=True):
        by_sheet.setdefault(sheet, []).append(shape)
    whole = {name: shapely.union_all(own) for name, own in by_sheet.items()}
    ground: BaseGeometry = shapely.Polygon()
    for name in sorted(whole, key=lambda one: (-whole[one].area, one)):
        # what a yard encloses counts as covered: sheets differ in back buildings
        covered = whole[name].intersection(ground.convex_hull).area
        if covered <= COVERED * whole[name].area:
            ground = ground.union(whole[name])
    return ground


def _exterior(shape: shapely.Geometry) -> Part:
    return shapely.get_coordinates(shapely.get_exterior_ring(shape))


def _polygons(shape: BaseGeometry | shapely.Geometry) -> list[shapely.Polygon]:
    parts = list(shapely.get_parts(shape))
    return [one for one in parts if isinstance(one, shapely.Polygon) and one.area > 0]
