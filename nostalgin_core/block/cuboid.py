"""A footprint and its elevations become a cuboid of matching proportions.

A wall of length w that shows an elevation of aspect a (width / height) is w / a high:
the paper's section 3.5. Several photographs of one building vote. A lot that no
photograph shows becomes a plain volume, marked as assumed.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from nostalgin_core import evidence
from nostalgin_core.block.chain import Footprint
from nostalgin_core.records import Building, Texture, Wall

LOWEST_M, HIGHEST_M = 2.5, 320.0  # a stall; the tallest masonry front of the time
ASSUMED_M = 14.0  # four storeys, where a whole block has no photograph
LEAST_SD = 0.02  # no aspect is trusted beyond 2 %


@dataclass(frozen=True, slots=True)
class Shown:
    """An elevation that shows a front, and how far its proportions are trusted."""

    texture: Texture
    aspect: float
    aspect_sd: float
    score: float


def height(footprint: Footprint, shown: Mapping[str, Sequence[Shown]]) -> float | None:
    """Find a building's height in metres from all elevations of all its fronts.

    It is the weighted median of w / a, each weighted by the score and by the inverse
    square of the aspect's relative spread: one bad quad among three does not move it.
    None where no elevation gives a height between a stall's and a tower's.
    """
    heights_m, weights = [], []
    for width_m, front_id in zip(
        edge_lengths(footprint), footprint.front_ids, strict=True
    ):
        for one in shown.get(front_id or "", ()):
            candidate = width_m / one.aspect
            if LOWEST_M <= candidate <= HIGHEST_M:
                spread = max(one.aspect_sd / one.aspect, LEAST_SD)
                heights_m.append(candidate)
                weights.append(max(one.score, 1e-3) / spread**2)
    return weighted_median(heights_m, weights) if heights_m else None


def weighted_median(values: Sequence[float], weights: Sequence[float]) -> float:
    """Find the value with half the weight on either side; between two, their mean."""
    order = np.argsort(values, kind="stable")
    value, weight = np.asarray(values, float)[order], np.asarray(weights, float)[order]
    passed = np.cumsum(weight) - weight.sum() / 2
    index = int(np.searchsorted(passed, 0.0))
    if np.isclose(passed[index], 0.0) and index + 1 < len(value):
        return float((value[index] + value[index + 1]) / 2)
    return float(value[index])


def edge_lengths(footprint: Footprint) -> list[float]:
    """Measure the four edges, in metres."""
    ahead = np.roll(footprint.corners_m, -1, axis=0) - footprint.corners_m
    return [float(length) for length in np.hypot(*ahead.T)]


def cuboid(
    footprint: Footprint,
    shown: Mapping[str, Sequence[Shown]],
    *,
    assumed_m: float = ASSUMED_M,
    copied: bool = False,
) -> Building:
    """Raise a building and hang its elevations.

    A front wears its best elevation. Where a wall stands on a street and no photograph
    shows it, it wears a copy of the building's best (COPIED); so do the other walls if
    `copied` (the paper tiles what it has round all four sides), else they are plain
    (ASSUMED), as party walls mostly are.
    """
    height_m = height(footprint, shown)
    best = {
        front_id: max(shown[front_id], key=lambda one: (one.score, one.texture))
        for front_id in footprint.front_ids
        if front_id and shown.get(front_id)
    }
    spare = max(best.values(), key=lambda one: (one.score, one.texture), default=None)
    walls = []
    for index, front_id in enumerate(footprint.front_ids):
        start, end = footprint.corners_m[index], footprint.corners_m[(index + 1) % 4]
        texture, code = None, evidence.ASSUMED
        if front_id in best:
            texture, code = best[front_id].texture, None
        elif spare is not None and (copied or front_id or index <= footprint.turns):
            texture, code = spare.texture, evidence.COPIED
        walls.append(
            Wall(
                start_m=(float(start[0]), float(start[1])),
                end_m=(float(end[0]), float(end[1])),
                front_id=front_id,
                texture=texture,
                evidence=code,
            )
        )
    return Building(
        building_id=footprint.building_id,
        footprint_m=footprint.corners_m,
        height_m=assumed_m if height_m is None else height_m,
        walls=tuple(walls),
        assumed=height_m is None,
    )
