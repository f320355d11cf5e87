"""Rows that corrections change, each found by what a correction names it by.

A row is looked at once as it is added, and again only by who changes it: many
corrections of a large manifest cost what they touch, and not the manifest each.
"""

from collections import defaultdict
from collections.abc import Collection, Iterator
from dataclasses import replace
from itertools import accumulate

from nostalgin_core.records import Front
from pipelines.index.row import Row

Places = dict[int, None]  # of rows, in their order


class Rows:
    """Rows in their order."""

    def __init__(self) -> None:
        """Begin with none."""
        self._rows: dict[int, Row] = {}
        self._next = 0
        self._of_photo: dict[str, Places] = defaultdict(dict)
        self._of_front: dict[str, Places] = defaultdict(dict)
        self._of_building: dict[str, Places] = defaultdict(dict)
        self._of_ring: dict[tuple[str, int], Places] = defaultdict(dict)

    def __iter__(self) -> Iterator[Row]:
        """Give the rows as they are now."""
        return iter(self._rows.values())

    def add(self, row: Row) -> None:
        """Put a row after all others."""
        self._rows[self._next] = row
        for places in self._named(row):
            places[self._next] = None
        self._next += 1

    def of_photo(self, photo: str) -> list[Row]:
        """List the rows of a photograph."""
        return [self._rows[place] for place in self._of_photo.get(photo, ())]

    def front(self, front_id: str) -> Front | None:
        """Give a front as its first row tells it."""
        return next((front for _, front in self._fronts(front_id)), None)

    def has_front(self, front: Front) -> bool:
        """Tell whether a row has this front of this block."""
        return any(one.block == front.block for _, one in self._fronts(front.front_id))

    def fronts_of_building(self, building_id: str) -> list[Front]:
        """List the fronts of a building's rows, named as block-lot."""
        return self._at(self._of_building.get(building_id, {}))

    def fronts_of_ring(self, block: str, ring: int) -> list[Front]:
        """List the fronts of a ring's rows."""
        return self._at(self._of_ring.get((block, ring), {}))

    def names_beside(self, front_id: str) -> list[str]:
        """Name the fronts of the lot that a front's name begins with."""
        begins = accumulate(front_id.split("-")[:-1], "{}-{}".format)
        places = sorted({p for one in begins for p in self._of_building.get(one, ())})
        return list(dict.fromkeys(one.front_id for one in self._at(places)))

    def mend(self, front_id: str, **fields: float) -> None:
        """Change a front in all its rows; block, lot and ring stay."""
        for place, front in list(self._fronts(front_id)):
            mended = replace(front, **fields)  # type: ignore[arg-type]
            self._rows[place] = replace(self._rows[place], front=mended)

    def drop_photo(self, photo: str) -> None:
        """Take the rows of a photograph away."""
        for place in list(self._of_photo.get(photo, ())):
            self._drop(place)

    def drop_bare(self, front_ids: Collection[str]) -> None:
        """Take the rows without a photograph of some fronts away."""
        for name in front_ids:
            for place, _ in list(self._fronts(name)):
                if not self._rows[place].photo:
                    self._drop(place)

    def _drop(self, place: int) -> None:
        for places in self._named(self._rows.pop(place)):
            del places[place]

    def _named(self, row: Row) -> Iterator[Places]:
        yield self._of_photo[row.photo]
        if row.front is not None:
            yield self._of_front[row.front.front_id]
            yield self._of_building[f"{row.front.block}-{row.front.lot}"]
            yield self._of_ring[row.front.block, row.front.ring]

    def _fronts(self, front_id: str) -> Iterator[tuple[int, Front]]:
        for place in self._of_front.get(front_id, ()):
            front = self._rows[place].front
            if front is not None:
                yield place, front

    def _at(self, places: Collection[int]) -> list[Front]:
        fronts = (self._rows[place].front for place in places)
        return [one for one in fronts if one is not None]
