"""Neighbours put together, and these again, until one group is left.

Sort-tile-recursive packing (Leutenegger, Lopez, Edgington, ICDE 1997): in slices by
east, each slice cut by north. It takes n log n, and equal input gives equal groups.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from nostalgin_core.arrays import Points

MOST = 16  # in a group


@dataclass(frozen=True, slots=True)
class Group:
    """Blocks, by number, or groups of them."""

    blocks: tuple[int, ...] = ()
    groups: tuple["Group", ...] = ()

    @property
    def level(self) -> int:
        """Tell how many steps down the blocks are."""
        return 1 + max((one.level for one in self.groups), default=0)

    def all_blocks(self) -> list[int]:
        """List all blocks below."""
        below = [number for one in self.groups for number in one.all_blocks()]
        return [*self.blocks, *below]


def grouped(centres_m: Points, *, most: int = MOST) -> Group:
    """Group blocks by their centres; no group has more than `most` members."""
    packs = packed(centres_m, most=most)
    groups = [Group(blocks=tuple(pack)) for pack in packs]
    middles = np.array([centres_m[pack].mean(axis=0) for pack in packs])
    while len(groups) > 1:
        packs = packed(middles, most=most)
        groups = [Group(groups=tuple(groups[n] for n in pack)) for pack in packs]
        middles = np.array([middles[pack].mean(axis=0) for pack in packs])
    return groups[0]


def packed(points: Points, *, most: int) -> list[list[int]]:
    """Cut points into packs of neighbours, as few as there may be."""
    count = -(-len(points) // most)
    slices = max(1, round(np.sqrt(count)))
    per_slice = -(-count // slices) * most
    by_east = sorted(range(len(points)), key=lambda n: (points[n, 0], points[n, 1], n))
    packs = []
    for part in _cut(by_east, per_slice):
        by_north = sorted(part, key=lambda n: (points[n, 1], points[n, 0], n))
        packs += [sorted(pack) for pack in _cut(by_north, most)]
    return packs


def _cut(numbers: Sequence[int], most: int) -> list[list[int]]:
    return [list(numbers[k : k + most]) for k in range(0, len(numbers), most)]
