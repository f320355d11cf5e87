"""Footprints that stay inside their ring and do not stand in one another.

Depths in a catalogue are of lots, not of buildings, and many are assumed. So a building
may reach through to the next street, or meet another in the middle of the block: it is
cut back, the deeper of two first, until they only touch. Fronts never move.
"""

from collections.abc import Callable, Sequence

import numpy as np
import shapely

from nostalgin_core.arrays import Corners, Points

TOUCH_M2 = 1e-3  # an overlap that is no more than rounding
LEAST = 0.05  # of its depth that a building keeps


def apart(
    footprints: Sequence[Corners],
    turns: Sequence[int],
    *,
    outline_m: Points | None = None,
) -> list[Corners]:
    """Cut footprints back until all lie in the outline and none overlaps another.

    `turns` counts the ring's corners that each one stands round: at one corner only
    the inner corner gives way, at two or more nothing does. In sharp corners a pair may
    find no room; then both keep the least depth.
    """
    kept = [
        _cut(np.asarray(corners, float), turn, lambda one: not _valid(one))
        for corners, turn in zip(footprints, turns, strict=True)
    ]
    if outline_m is not None:
        ground = _polygon(outline_m).buffer(1e-6)
        kept = [
            _cut(
                one, turn, lambda one: _polygon(one).difference(ground).area > TOUCH_M2
            )
            for one, turn in zip(kept, turns, strict=True)
        ]
    hopeless: set[tuple[int, int]] = set()
    for _ in range(6 * len(kept)):
        pair = _worst([_polygon(one) for one in kept], hopeless)
        if pair is None:
            break
        first, second = sorted(pair, key=lambda i: (turns[i], -_depth(kept[i]), i))
        for index, other in ((first, second), (second, first)):
            shape = _polygon(kept[other])
            kept[index] = _cut(
                kept[index], turns[index], lambda one, it=shape: _overlaps(one, it)
            )
        if _overlaps(kept[first], _polygon(kept[second])):
            hopeless.add(pair)
    return kept


def _polygon(points: Points) -> shapely.Polygon:
    """Make a polygon; where its edges cross, the hull stands for it."""
    shape = shapely.Polygon(points)
    if shape.is_valid:
        return shape
    hull = shapely.MultiPoint(points).convex_hull
    return hull if isinstance(hull, shapely.Polygon) else shapely.Polygon()


def _valid(corners: Corners) -> bool:
    """Tell whether a footprint's walls do not cross."""
    return bool(shapely.Polygon(corners).is_valid)


def _overlaps(corners: Corners, other: shapely.Polygon) -> bool:
    return _polygon(corners).intersection(other).area > TOUCH_M2


def _worst(
    shapes: Sequence[shapely.Polygon], hopeless: set[tuple[int, int]]
) -> tuple[int, int] | None:
    """Find the pair that overlaps most."""
    first, second = shapely.STRtree(shapes).query(shapes, predicate="intersects")
    pairs = [(int(a), int(b)) for a, b in zip(first, second, strict=True) if a < b]
    pairs = [pair for pair in pairs if pair not in hopeless]
    areas = [shapes[a].intersection(shapes[b]).area for a, b in pairs]
    if not areas or max(areas) <= TOUCH_M2:
        return None
    return pairs[int(np.argmax(areas))]


def _cut(corners: Corners, turns: int, faulty: Callable[[Corners], bool]) -> Corners:
    """Bring the back of a building forward until nothing is wrong, or to the least."""
    if turns > 1 or not faulty(corners):
        return corners
    low, high = LEAST, 1.0
    for _ in range(24):
        middle = (low + high) / 2
        wrong = faulty(_scaled(corners, middle, turns))
        low, high = (low, middle) if wrong else (middle, high)
    return _scaled(corners, low, turns)


def _scaled(corners: Corners, share: float, turns: int) -> Corners:
    """Keep a share of the depth; fronts stay where they are."""
    a, b, c, d = corners
    if turns:  # a, b, c lie on the streets, d inside
        middle = (a + c) / 2
        return np.array([a, b, c, middle + share * (d - middle)])
    return np.array([a, b, b + share * (c - b), a + share * (d - a)])


def _depth(corners: Corners) -> float:
    return float(np.linalg.norm(corners[3] - corners[0]))
