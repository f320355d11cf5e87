"""Grounds that are taken, found by where they lie.

A ground is kept in the cells that it touches of a square grid whose cells are no
smaller than itself: four at most. So what is near a place is found by looking at a few
cells, however many grounds there are.
"""

import math
from collections import defaultdict
from collections.abc import Iterator

import shapely
from shapely.geometry.base import BaseGeometry

Box = tuple[float, float, float, float]  # west, south, east, north
Cell = tuple[int, int]

TOUCH_M2 = 1.0  # blocks that share no more only touch


class Grounds:
    """Grounds that are added one by one."""

    def __init__(self) -> None:
        """Begin with none."""
        self._levels: dict[int, dict[Cell, list[int]]] = {}
        self._all: list[BaseGeometry] = []
        self._boxes: list[Box] = []
        self.east_m = -math.inf  # where the easternmost ends

    def __len__(self) -> int:
        """Count them."""
        return len(self._all)

    def add(self, ground: BaseGeometry) -> None:
        """Take a ground."""
        box = ground.bounds
        side = max(box[2] - box[0], box[3] - box[1], 1.0)
        level = math.ceil(math.log2(side))
        cells = self._levels.setdefault(level, defaultdict(list))
        for cell in _cells(box, level):
            cells[cell].append(len(self._all))
        self._all.append(ground)
        self._boxes.append(box)
        self.east_m = max(self.east_m, box[2])

    def near(self, box: Box) -> list[int]:
        """Name the grounds whose boxes meet a box, in the order they were added."""
        found: set[int] = set()
        for level, cells in self._levels.items():
            size = 2.0**level
            wide = (box[2] - box[0]) / size + 1
            high = (box[3] - box[1]) / size + 1
            few = wide * high < len(cells)
            keys = _cells(box, level) if few else iter(list(cells))
            for key in keys:
                found.update(cells.get(key, ()))
        return sorted(one for one in found if _meet(box, self._boxes[one]))

    def overlapping(self, ground: BaseGeometry) -> list[tuple[int, float]]:
        """Name the grounds that a ground stands on, and by how many square metres."""
        near = self.near(ground.bounds)
        if not near:
            return []
        areas = shapely.area(shapely.intersection([self._all[i] for i in near], ground))
        found = zip(near, areas, strict=True)
        return [(one, float(area)) for one, area in found if area > TOUCH_M2]

    def clear(self, ground: BaseGeometry) -> bool:
        """Tell whether a ground stands on none of them."""
        return not self.overlapping(ground)


def _cells(box: Box, level: int) -> Iterator[Cell]:
    size = 2.0**level
    for i in range(math.floor(box[0] / size), math.floor(box[2] / size) + 1):
        for j in range(math.floor(box[1] / size), math.floor(box[3] / size) + 1):
            yield i, j


def _meet(a: Box, b: Box) -> bool:
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]
