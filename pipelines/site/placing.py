"""Where a run's blocks lie, and how that is known."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from nostalgin_core import city
from nostalgin_core.records import Front
from pipelines.index import Anchors

Json = dict[str, Any]
CENTIMETRE = 2  # digits


@dataclass(frozen=True)
class Placing:
    """Where blocks lie in the city's plane, and on the globe if that is known."""

    moves: Mapping[str, city.Move]
    spots: Mapping[str, tuple[city.Place, float]]  # and the turn against east there
    origin: city.Place | None
    rows: tuple[Json, ...]  # of the run's table
    notes: tuple[str, ...]  # what is doubtful, with the remedy


def placing(plots: Sequence[city.Plot], anchors: Anchors) -> Placing:
    """Place the blocks by what is told of them, else by the streets that they share."""
    found = city.anchored(plots, anchors.of, widths=anchors.widths_m)
    spots = {} if found.plane is None else city.on_globe(found.plane, found.moves)
    standing = city.overlaps(plots, found.moves)
    notes = [found.told[one.block].note for one in plots if found.told[one.block].note]
    notes += [
        f"blocks {a} and {b} stand on one another by {area:,.0f} m2: mend their places"
        for a, b, area in standing
    ]
    told = [row_of(one, found, spots.get(one.block)) for one in plots]
    return Placing(found.moves, spots, found.origin, tuple(told), tuple(notes))


def plot_of(record: Mapping[str, Any], fronts: Iterable[Front]) -> city.Plot:
    """Give the ground of a block; of what is told of a front the first counts."""
    first: dict[str, Front] = {}
    for front in fronts:
        first.setdefault(front.front_id, front)
    outlines = [np.array(outline) for outline in record["outline_m"]]
    return city.plot(record["block"], outlines, list(first.values()))


def row_of(
    one: city.Plot, found: city.Settled, there: tuple[city.Place, float] | None
) -> Json:
    """Tell where one block lies: in its city's plane, and on the globe."""
    move, told = found.moves[one.block], found.told[one.block]
    ahead = one.outlines_m[0][1] - one.outlines_m[0][0]
    row: Json = {
        "block": one.block,
        "how": told.how,
        "east_m": move.east_m,
        "north_m": move.north_m,
        "turn_rad": move.turn_rad,
        "misfit_m": told.misfit_m,
        "note": told.note,
    }
    if there is not None:
        place, turn = there
        row |= {
            "longitude_deg": place.longitude_deg,
            "latitude_deg": place.latitude_deg,
            "bearing_deg": city.bearing_of(turn, float(np.arctan2(*ahead[::-1]))),
        }
    return row


def spot(row: Json) -> Json:
    """Tell readers of the site where a block's frame lies, and how that is known."""
    names = ("longitude_deg", "latitude_deg", "bearing_deg", "how", "misfit_m")
    kept = {name: row[name] for name in names if row.get(name) is not None}
    digits = {"bearing_deg": CENTIMETRE, "misfit_m": CENTIMETRE}
    return {n: round(v, digits[n]) if n in digits else v for n, v in kept.items()}
