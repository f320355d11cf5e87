"""Where a finished city's buildings stand: by which sides, how closed, on whom."""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import shapely

from nostalgin_core.arrays import Points
from nostalgin_core.city import Move, carried

TOUCH_M2: Final = 0.5  # two buildings that share no more only touch
BESIDE_M: Final = 0.05  # of a building, and a place on the outline is closed
LEAST_M: Final = 1.0  # of a side: a building that borders less only touches it

Told = dict[str, Any]  # a row of a run's table, or of a report


@dataclass(frozen=True, slots=True)
class Stretch:
    """What a building takes of one side of a ring."""

    ring: int
    side: int
    from_m: float  # along the side, seen from the street from left to right
    to_m: float


def stretches(
    built: Sequence[Told], blocks: Sequence[Told]
) -> dict[str, list[Stretch]]:
    """Tell, by lot (`993-5`), which sides its buildings border, and where."""
    outlines = {one["block"]: outlines_of(one) for one in blocks}
    found: dict[str, list[Stretch]] = defaultdict(list)
    for one in built:
        ground = shapely.Polygon(footprint(one)).buffer(BESIDE_M)
        for ring, outline in enumerate(outlines.get(one["block"], [])):
            found[f"{one['block']}-{one['lot']}"] += bordered(ground, ring, outline)
    return found


def bordered(ground: shapely.Geometry, ring: int, outline: Points) -> Iterator[Stretch]:
    """Give what of an outline's sides lies on a ground."""
    ends = np.roll(outline, -1, axis=0) if len(outline) > 2 else outline[1:]
    for side, (start, end) in enumerate(zip(outline, ends, strict=False)):
        line = shapely.LineString([start, end])
        on = shapely.intersection(line, ground)
        if on.length > LEAST_M:
            spots = shapely.line_locate_point(
                line, shapely.points(shapely.get_coordinates(on))
            )
            yield Stretch(ring, side, float(spots.min()), float(spots.max()))


def outlines_of(block: Told) -> list[Points]:
    """Read a block's outlines, one a ring."""
    return [np.reshape(one, (-1, 2)) for one in block["outlines_m"]]


def footprint(one: Told) -> Points:
    """Read a building's footprint."""
    return np.reshape(one["footprint_m"], (-1, 2))


def rings(block: Told, built: Sequence[Told]) -> list[Told]:
    """Tell how each ring of a block closes, before and after its walls were made."""
    grounds = [
        shapely.Polygon(footprint(one))
        for one in built
        if one["block"] == block["block"]
    ]
    covered = shapely.union_all([one.buffer(BESIDE_M) for one in grounds])
    return [
        {
            "ring": f"{block['block']} ring {number}",
            "before_m": before,
            "after_m": shapely.LinearRing(outline).difference(covered).length
            if len(outline) > 2
            else None,  # a row of houses is no ring
        }
        for number, (outline, before) in enumerate(
            zip(outlines_of(block), block["closures_m"], strict=True)
        )
    ]


def overlapping(built: Sequence[Told], moves: Mapping[str, Move]) -> list[Told]:
    """Find buildings of a city that stand on one another, and on how much ground."""
    names, shapes = [], []
    for one in built:
        corners = footprint(one)
        if one["block"] in moves and len(corners) > 2:
            names.append(one["building_id"])
            shapes.append(shapely.Polygon(carried(moves[one["block"]], corners)))
    first, second = shapely.STRtree(shapes).query(shapes, predicate="intersects")
    found = []
    for a, b in sorted(zip(first.tolist(), second.tolist(), strict=True)):
        area = shapely.intersection(shapes[a], shapes[b]).area if a < b else 0.0
        if area > TOUCH_M2:
            found.append({"buildings": [names[a], names[b]], "area_m2": area})
    return found
