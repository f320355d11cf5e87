"""Blocks whose place on the globe is told, by an outline or by a point.

An outline tells where a block's rings lie (`fit`), but not which way round. A point
tells not even how they are turned. That the neighbours tell (`turned`). Blocks without
an anchor stand by those that have one.
"""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import median

import numpy as np
import shapely
from jaxtyping import Float

from nostalgin_core.city.city import places
from nostalgin_core.city.fit import Fit, fit, nearest, quarters
from nostalgin_core.city.globe import Plane, metres_apart, plane_of, turn_of
from nostalgin_core.city.grounds import Grounds
from nostalgin_core.city.plot import (
    Move,
    Plot,
    about,
    centre,
    ground,
    heading,
    middle,
    moved,
)
from nostalgin_core.city.tileset import Place
from nostalgin_core.city.turned import expected
from nostalgin_core.city.ways import Widths, pairs

ANOTHER_CITY_M = 100_000.0
LARGER = 3.0  # an outline so many times a block's size is another's
POOR_M = 8.0  # such a misfit is told
ALIKE = 1.15  # two fits that differ by less than this factor are equally good
STREET_M = (3.0, 100.0)  # widths that a street may have
SQUARE = 0.97  # cosine: sides that face each other are that parallel


@dataclass(frozen=True, slots=True, eq=False)
class Anchor:
    """What is told of a block's place, in degrees: its middle, or its outline too."""

    longitude_deg: float
    latitude_deg: float
    bearing_deg: float | None = None  # of its first side, block on the left hand
    outline_deg: tuple[
        Float[np.ndarray, "_ 2"], ...
    ] = ()  # longitude, latitude; one closed ring a part


@dataclass(frozen=True, slots=True)
class Told:
    """How a block got its place."""

    how: str  # "outline", "point", or "streets": relative to others
    misfit_m: float | None = None
    note: str = ""  # what is doubtful, with the remedy


@dataclass(frozen=True, slots=True, eq=False)
class Settled:
    """Where blocks stand; on the globe, if one of them was anchored."""

    moves: dict[str, Move]
    told: dict[str, Told]
    widths_m: dict[str, float]  # of streets, as measured between outlines
    plane: Plane | None

    @property
    def origin(self) -> Place | None:
        """Where the city's plane touches the globe."""
        return None if self.plane is None else self.plane.origin


def anchored(
    plots: Sequence[Plot],
    anchors: Mapping[str, Anchor],
    *,
    widths: Widths | None = None,
) -> Settled:
    """Place all blocks: the anchored where they are told to be, the others by streets.

    An anchor that can't be right (of another city, of another size) is left out, and
    its block stands by its streets, with a note. `widths` go before measured ones.
    """
    known = {one.block: anchors[one.block] for one in plots if one.block in anchors}
    notes = _elsewhere(known)
    known = {block: one for block, one in known.items() if block not in notes}
    if not known:
        moves = places(plots, widths=widths)
        told = {block: Told("streets", note=notes.get(block, "")) for block in moves}
        return Settled(moves, told, {}, None)
    plane = plane_of(_degrees(known.values()))
    by_block = {one.block: one for one in plots}
    there = plane.metres(_degrees(known.values()))
    turns = expected(plots, dict(zip(known, there, strict=True)), widths=widths)
    told = {block: Told("streets", note=note) for block, note in notes.items()}
    given: dict[str, Move] = {}
    for block, one in known.items():
        own = by_block[block]
        asked = _asked(own, one) if one.bearing_deg is not None else turns.get(block)
        move, told[block] = _anchored(own, one, plane, asked)
        if move is not None:
            given[block] = move
    outlined = [by_block[one] for one in given if told[one].how == "outline"]
    measured = streets(outlined, given)
    moves = places(plots, given=given, widths={**measured, **(widths or {})})
    for one in plots:
        told.setdefault(one.block, Told("streets"))
    return Settled(moves, told, measured, plane)


def streets(plots: Sequence[Plot], moves: Mapping[str, Move]) -> dict[str, float]:
    """Measure streets between blocks that stand: from side to side, in the median."""
    standing = [moved(one, moves[one.block]) for one in plots]
    found: dict[str, list[float]] = defaultdict(list)
    for rank, _, one, other, side, there in pairs(plots):
        if rank > 1:
            continue
        mine, theirs = standing[one].borders[side], standing[other].borders[there]
        turn = heading(mine) - heading(theirs)
        out = np.array([np.sin(heading(theirs)), -np.cos(heading(theirs))])
        wide = float((middle(mine) - middle(theirs)) @ out)
        if -np.cos(turn) > SQUARE and STREET_M[0] <= wide <= STREET_M[1]:
            found[mine.street].append(wide)
    return {street: median(wide) for street, wide in sorted(found.items())}


def gap_m(one: Anchor) -> float | None:
    """Measure the street between the two parts of an outline; None if that is none."""
    if len(one.outline_deg) != 2:
        return None
    plane = plane_of(_degrees([one]))
    first, second = (shapely.Polygon(plane.metres(part)) for part in one.outline_deg)
    wide = float(shapely.distance(first, second))
    return wide if STREET_M[0] <= wide <= STREET_M[1] else None


def overlaps(
    plots: Sequence[Plot], moves: Mapping[str, Move]
) -> list[tuple[str, str, float]]:
    """List blocks that stand on one another, and on how many square metres."""
    grounds, found = Grounds(), []
    for one in plots:
        mine = ground(moved(one, moves[one.block]))
        found += [
            (plots[other].block, one.block, area)
            for other, area in grounds.overlapping(mine)
        ]
        grounds.add(mine)
    return found


def _anchored(
    own: Plot, one: Anchor, plane: Plane, turn_rad: float | None
) -> tuple[Move | None, Told]:
    if not one.outline_deg:
        target = plane.metres(_degrees([one]))[0]
        note = "" if turn_rad is not None else _unturned(own.block)
        return about(turn_rad or 0.0, centre(own), target), Told("point", note=note)
    outline = [plane.metres(part) for part in one.outline_deg]
    share = shapely.MultiPoint(np.concatenate(outline)).convex_hull.area
    share /= max(shapely.MultiPoint(np.concatenate(own.outlines_m)).convex_hull.area, 1)
    if not 1 / LARGER <= share <= LARGER:
        note = (
            f"the outline of block {own.block} has {share:.2g} times the size of its "
            "fronts: is it another block's, or in other units? mend outlines.geojson"
        )
        return None, Told("streets", note=note)
    first = quarters(own.outlines_m, outline)
    if turn_rad is not None:
        first = [nearest(first, turn_rad)]
    found = fit(own.outlines_m, outline, first)
    best = found[0]
    return best.move, Told("outline", best.misfit_m, _doubt(own.block, found))


def _doubt(block: str, found: Sequence[Fit]) -> str:
    if len(found) > 1 and found[1].cost_m < ALIKE * found[0].cost_m:
        return _unturned(block)
    if found[0].misfit_m > POOR_M:
        return (
            f"block {block} lies {found[0].misfit_m:.0f} m off its outline in the "
            "median: mend its widths in manifest.csv, or its outline"
        )
    return ""


def _unturned(block: str) -> str:
    return (
        f"nothing tells which way round block {block} stands: give the bearing of its "
        "first side in places.csv"
    )


def _elsewhere(anchors: Mapping[str, Anchor]) -> dict[str, str]:
    """Say which blocks are told to lie in another city than most."""
    if len(anchors) < 2:
        return {}
    origin = plane_of(_degrees(anchors.values())).origin
    at = np.array([origin.longitude_deg, origin.latitude_deg])
    apart = {
        block: metres_apart(at, _degrees([one])[0]) for block, one in anchors.items()
    }
    return {
        block: f"block {block} is told to lie {far / 1000:,.0f} km from the others: "
        "is its place another city's? mend places.csv or outlines.geojson"
        for block, far in apart.items()
        if far > ANOTHER_CITY_M
    }


def _asked(own: Plot, one: Anchor) -> float:
    first = own.outlines_m[0]
    ahead = first[1] - first[0]
    return turn_of(one.bearing_deg or 0.0, float(np.arctan2(*ahead[::-1])))


def _degrees(anchors: Iterable[Anchor]) -> Float[np.ndarray, "n 2"]:
    return np.array([[one.longitude_deg, one.latitude_deg] for one in anchors])
