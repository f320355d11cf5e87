"""A footprint and its elevations become a cuboid of matching proportions.

How high it is, `heights` tells. A lot that no photograph shows becomes a plain volume,
marked as assumed.
"""

from collections.abc import Collection, Mapping, Sequence
from statistics import median

import numpy as np

from nostalgin_core import evidence
from nostalgin_core.block.chain import Footprint
from nostalgin_core.block.heights import HIGHEST_M, LOWEST_M, Shown, Told
from nostalgin_core.records import Building, Front, Height, Wall

LEAST_CLEAR = 0.5  # of an elevation, or it is mostly invented: a plain wall then
ASSUMED_M = 14.0  # four storeys, where a whole block has no photograph


def told(
    footprint: Footprint,
    shown: Mapping[str, Sequence[Shown]],
    guessed: Collection[str] = (),
) -> list[Told]:
    """List what the elevations of a building's fronts say of its height.

    `guessed` names the fronts whose widths nobody knows. An elevation whose wall and
    proportions give a height that no building has says nothing; nor does one that a
    neighbour lent, where the building's own speak (`nostalgin evaluate heights` tells
    that they know better).
    """
    widths_m = edge_lengths(footprint)
    every = [
        Told(width_m, front_id in guessed, one)
        for width_m, front_id in zip(widths_m, footprint.front_ids, strict=True)
        for one in shown.get(front_id or "", ())
        if LOWEST_M <= width_m / one.aspect <= HIGHEST_M
    ]
    return [one for one in every if not one.shown.lent] or every


def counts(fronts: Sequence[Front]) -> dict[str, float]:
    """List the storeys that a catalogue gives, by front."""
    return {one.front_id: one.storeys for one in fronts if one.storeys is not None}


def listed(footprint: Footprint, storeys: Mapping[str, float]) -> float | None:
    """Tell the storeys that a catalogue gives a building's fronts, if it does."""
    given = [storeys[name] for name in footprint.front_ids if name and name in storeys]
    return float(median(given)) if given else None


def legible(shown: Sequence[Shown]) -> list[Shown]:
    """Leave out elevations that are mostly invented or smeared."""
    return [one for one in shown if one.clear >= LEAST_CLEAR]


def edge_lengths(footprint: Footprint) -> list[float]:
    """Measure the four edges, in metres."""
    ahead = np.roll(footprint.corners_m, -1, axis=0) - footprint.corners_m
    return [float(length) for length in np.hypot(*ahead.T)]


def cuboid(
    footprint: Footprint,
    shown: Mapping[str, Sequence[Shown]],
    height: Height | None = None,
    *,
    assumed_m: float = ASSUMED_M,
    copied: bool = False,
) -> Building:
    """Raise a building and hang its elevations.

    A front wears its best elevation, unless next to nothing of that is clear: mostly
    invented or smeared. Where a wall stands on a street and no photograph shows it
    well, it wears a copy of the building's best (COPIED); so do the other walls if
    `copied` (the paper tiles what it has round all four sides), else they are plain
    (ASSUMED), as party walls mostly are.
    """
    best = {
        front_id: max(clear, key=lambda one: (one.score, one.texture))
        for front_id in footprint.front_ids
        if front_id and (clear := legible(shown.get(front_id, ())))
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
        height_m=assumed_m if height is None else height.height_m,
        walls=tuple(walls),
        assumed=height is None,
        height=height,
    )
