"""Blocks take their places by the streets between them.

The paper calls it a trivial extension: given where each block lies relative to others.
Here that is found from the catalogue (`ways`). Blocks whose place is given stand there;
where none is, the first of all stays where it is. The others are placed one by one, the
surest way first by which a block may stand to one that stands already. A way that is
not clear never will be, for blocks that stand never go; so each is tried once. A block
that shares no street with any that stands goes by itself, to the east.

For n blocks that is n log n: each has a few ways (`ways.pairs`), they wait in a heap,
and what a block would stand on is found by where it lies (`grounds`).
"""

import heapq
from collections import defaultdict
from collections.abc import Mapping, Sequence

import shapely
from shapely.geometry.base import BaseGeometry

from nostalgin_core.block import FALLBACK_GAP_M
from nostalgin_core.city.grounds import Grounds
from nostalgin_core.city.plot import Move, Plot, carried, ground, moved
from nostalgin_core.city.ways import Pair, Widths, pairs, ways


def places(
    plots: Sequence[Plot],
    *,
    given: Mapping[str, Move] | None = None,
    widths: Widths | None = None,
) -> dict[str, Move]:
    """Find where each block goes: given ones there, others by those that stand.

    `widths` are streets' in metres by plain names; others follow from their names.
    Given blocks may overlap: they stand where they are told to.
    """
    made = _Placing(plots, widths or {})
    for index, one in enumerate(plots):
        if given and one.block in given:
            made.stand(index, given[one.block])
    made.follow()
    for index, one in enumerate(plots):
        if one.block not in made.moves:
            made.stand(index, made.beside(index))
            made.follow()
    return {one.block: made.moves[one.block] for one in plots}


class _Placing:
    """The blocks that stand, and the ways that were not tried yet."""

    def __init__(self, plots: Sequence[Plot], widths: Widths) -> None:
        self.moves: dict[str, Move] = {}
        self._plots, self._widths = plots, widths
        self._local = [ground(one) for one in plots]
        self._grounds = Grounds()
        self._standing: dict[int, Plot] = {}
        self._ways: dict[int, list[Pair]] = defaultdict(list)  # by who must stand
        for pair in pairs(plots):
            self._ways[pair[3]].append(pair)
        self._tries: list[Pair] = []

    def stand(self, index: int, move: Move) -> None:
        """Put a block in its place; its neighbours may now try to stand to it."""
        self.moves[self._plots[index].block] = move
        self._standing[index] = moved(self._plots[index], move)
        self._grounds.add(self._there(index, move))
        for pair in self._ways[index]:
            if pair[2] not in self._standing:
                heapq.heappush(self._tries, pair)

    def follow(self) -> None:
        """Place whatever can be placed by those that stand."""
        while self._tries:
            _, _, index, other, side, there = heapq.heappop(self._tries)
            if index in self._standing:
                continue
            mine = self._plots[index].borders[side]
            theirs = self._standing[other].borders[there]
            for move in ways(mine, theirs, self._widths):
                if self._grounds.clear(self._there(index, move)):
                    self.stand(index, move)
                    break

    def beside(self, index: int) -> Move:
        """Find room to the east of all."""
        if not self._grounds:
            return Move()
        left = min(outline[:, 0].min() for outline in self._plots[index].outlines_m)
        return Move(east_m=float(self._grounds.east_m - left + FALLBACK_GAP_M))

    def _there(self, index: int, move: Move) -> BaseGeometry:
        return shapely.transform(self._local[index], lambda xy: carried(move, xy))
