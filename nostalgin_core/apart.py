"""Footprints that do not stand in one another.

Depths in a catalogue are of lots, not of buildings, and many are assumed. So buildings
from opposite streets may meet in the middle of the block: the deeper one is cut back
until they only touch. Fronts never move.
"""

from collections.abc import Sequence

import numpy as np
import shapely

from nostalgin_core.arrays import Corners

TOUCH_M2 = 1e-4  # an overlap that is no more than rounding
LEAST = 0.15  # of its depth that a building keeps


def apart(footprints: Sequence[Corners], turns: Sequence[int]) -> list[Corners]:
    """Cut footprints back until none overlaps another.

    `turns` counts the ring's corners that each one stands round: at one corner only
    the inner corner gives way, at two or more nothing does.
    """
    kept = [np.asarray(corners, float) for corners in footprints]
    for _ in range(4 * len(kept)):
        shapes = [shapely.Polygon(corners) for corners in kept]
        pair = _worst(shapes)
        if pair is None:
            break
        a, b = sorted(
            pair, key=lambda index: (turns[index], -_depth(kept[index]), index)
        )
        for index, other in ((a, b), (b, a)):
            cut = _cut(kept[index], shapes[other], turns[index])
            if cut is not None:
                kept[index] = cut
                break
        else:
            break  # neither can give way: they stay as they are
    return kept


def _worst(shapes: Sequence[shapely.Polygon]) -> tuple[int, int] | None:
    """Find the pair that overlaps most."""
    first, second = shapely.STRtree(shapes).query(shapes, predicate="intersects")
    pairs = [(int(a), int(b)) for a, b in zip(first, second, strict=True) if a < b]
    areas = [shapes[a].intersection(shapes[b]).area for a, b in pairs]
    if not areas or max(areas) <= TOUCH_M2:
        return None
    return pairs[int(np.argmax(areas))]


def _cut(corners: Corners, other: shapely.Polygon, turns: int) -> Corners | None:
    """Bring the back of a building forward until it clears another."""
    if turns > 1 or _overlap(_scaled(corners, LEAST, turns), other) > TOUCH_M2:
        return None
    low, high = LEAST, 1.0
    for _ in range(30):
        middle = (low + high) / 2
        clear = _overlap(_scaled(corners, middle, turns), other) <= TOUCH_M2 / 2
        low, high = (middle, high) if clear else (low, middle)
    return _scaled(corners, low, turns)


def _overlap(corners: Corners, other: shapely.Polygon) -> float:
    return shapely.Polygon(corners).intersection(other).area


def _scaled(corners: Corners, share: float, turns: int) -> Corners:
    """Keep a share of the depth; fronts stay where they are."""
    a, b, c, d = corners
    if turns:  # a, b, c lie on the streets, d inside
        middle = (a + c) / 2
        return np.array([a, b, c, middle + share * (d - middle)])
    return np.array([a, b, b + share * (c - b), a + share * (d - a)])


def _depth(corners: Corners) -> float:
    return float(np.linalg.norm(corners[3] - corners[0]))
