"""How blocks are turned whose middles alone are known.

Places by streets alone are turned to meet the known middles of the nearest blocks
(Kabsch 1976), reweighted, so that one that is told a wrong place turns no other.
"""

from collections import defaultdict
from collections.abc import Mapping, Sequence

import numpy as np
import scipy

from nostalgin_core.arrays import Points
from nostalgin_core.city.city import places
from nostalgin_core.city.plot import Plot, Vector, centre, moved
from nostalgin_core.city.ways import Widths, pairs

NEIGHBOURS = 16  # blocks that tell how one is turned
ROUNDS = 4  # of weighing them
REACH_M = 30.0  # a neighbour that is further off than the others tells less


def expected(
    plots: Sequence[Plot],
    middles_m: Mapping[str, Vector],
    *,
    widths: Widths | None = None,
) -> dict[str, float]:
    """Tell how each block of a known middle is turned, by where its neighbours lie.

    A block without another that its streets join it to tells none.
    """
    relative = places(plots, widths=widths)
    groups: dict[int, list[Plot]] = defaultdict(list)
    for one, group in zip(plots, joined(plots), strict=True):
        if one.block in middles_m:
            groups[group].append(one)
    turns = {}
    for group in groups.values():
        if len(group) < 2:
            continue
        there = np.array([middles_m[one.block] for one in group])
        here = np.array([centre(moved(o, relative[o.block])) for o in group])
        _, near = scipy.spatial.KDTree(there).query(
            there, k=min(NEIGHBOURS, len(group))
        )
        for one, those in zip(group, np.asarray(near), strict=True):
            turn = _turn(here[those], there[those])
            if turn is not None:
                turns[one.block] = relative[one.block].turn_rad + turn
    return turns


def joined(plots: Sequence[Plot]) -> list[int]:
    """Number the groups of blocks that streets join, by their first block."""
    group = list(range(len(plots)))

    def first(index: int) -> int:
        while group[index] != index:
            group[index] = group[group[index]]
            index = group[index]
        return index

    for _, _, one, other, *_ in pairs(plots):
        a, b = sorted((first(one), first(other)))
        group[b] = a
    return [first(index) for index in range(len(plots))]


def _turn(here: Points, there: Points) -> float | None:
    """Find the turn that brings points together, whatever a few of them say."""
    weight = np.ones(len(here))
    turn = None
    for _ in range(ROUNDS):
        own = here - np.average(here, axis=0, weights=weight)
        seen = there - np.average(there, axis=0, weights=weight)
        a, b = own @ np.array([1, 1j]), seen @ np.array([1, 1j])
        whole = (weight * np.conj(a) * b).sum()
        if abs(whole) < 1.0:  # square metres: all in one place
            return None
        turn = float(np.angle(whole))
        apart = np.abs(a * np.exp(1j * turn) - b)
        weight = 1.0 / (1.0 + (apart / REACH_M) ** 2)
    return turn
