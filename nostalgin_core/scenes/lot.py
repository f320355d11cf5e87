"""One lot with its building: a box on all of it, the same house on each of its fronts.

Sides run anticlockwise seen from above: 0 looks south, 1 east, 2 north, 3 west.
"""

from dataclasses import dataclass, replace

import numpy as np

from nostalgin_core.arrays import Corners
from nostalgin_core.records import Front
from nostalgin_core.scenes.style import FrontStyle, style_for

Place = tuple[float, float]  # east, north in metres
TRIES = 6
OUTWARD = ((0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0))  # by side


@dataclass(frozen=True, slots=True, eq=False)
class Wall:
    """One front in the world, or a blank party wall where `front` is missing."""

    start_m: Place  # its left end, seen from outside
    end_m: Place
    height_m: float
    style: FrontStyle | None
    front: Front | None


@dataclass(frozen=True, slots=True, eq=False)
class Lot:
    """One lot, its building a box on all of it."""

    block: str
    lot: str
    footprint_m: Corners  # anticlockwise, from its first front's left end
    height_m: float
    walls: tuple[Wall, ...]  # one per footprint edge, in that order
    photos: int  # how many photographs the archive holds
    ruined: bool  # the only photograph shows nothing but fog

    @property
    def fronts(self) -> tuple[Front, ...]:
        """Its one or two fronts, anticlockwise."""
        return tuple(wall.front for wall in self.walls if wall.front)


def build(
    rng: np.random.Generator,
    key: tuple[str, str],
    box: tuple[float, float, float, float],
    sides: tuple[tuple[int, int, str, str], ...],
    *,
    sun: tuple[float, float, float],
    beside: FrontStyle | None,
) -> Lot:
    """Put one building on a lot, the same house on each of its sides."""
    west, south, east, north = box
    ends = ((west, south), (east, south), (east, north), (west, north))
    first = sides[0][0]
    spans = (east - west, north - south)
    look = choose(
        rng,
        width_m=spans[first % 2],
        open_sides=[side[0] for side in sides],
        beside=beside,
    )
    walls: list[Wall] = []
    for turn in range(4):
        side = (first + turn) % 4
        start, end = ends[side], ends[(side + 1) % 4]
        found = next((entry for entry in sides if entry[0] == side), None)
        style = front = None
        if found:
            style = replace(
                look, width_m=spans[side % 2], wing=turn, sun=on_wall(sun, side)
            )
            front = Front(
                front_id=f"{key[0]}-{key[1]}-{side}",
                block=key[0],
                lot=key[1],
                ring=0,
                side=side,
                rank=found[1],
                street=found[2],
                address=found[3],
                width_m=spans[side % 2],
                depth_m=spans[1 - side % 2],
                width_assumed=False,
            )
        walls.append(Wall(start, end, look.height_m, style, front))
    footprint = np.array([ends[(first + turn) % 4] for turn in range(4)])
    return Lot(
        key[0], key[1], footprint, look.height_m, tuple(walls), photos=1, ruined=False
    )


def choose(
    rng: np.random.Generator,
    *,
    width_m: float,
    open_sides: list[int],
    beside: FrontStyle | None,
) -> FrontStyle:
    """Choose a house no higher than its street lets a camera see.

    A builder wanted his house told from its neighbour: a few tries are made at another
    tone and another roof line.
    """
    avenue = any(side % 2 for side in open_sides)
    limit = 25.0 if avenue else 19.0
    for _ in range(TRIES):
        look = style_for(rng, width_m=width_m)
        while look.height_m > limit and look.storeys > 2:
            look = replace(look, storeys=look.storeys - 1)
        if beside is None or unlike(look, beside):
            break
    return look


def unlike(one: FrontStyle, other: FrontStyle) -> bool:
    """Say whether two houses differ in tone and height at a glance."""
    tone = abs(np.log(one.albedo / other.albedo))
    return bool(tone > 0.28 and abs(one.height_m - other.height_m) > 0.8)


def on_wall(sun: tuple[float, float, float], side: int) -> tuple[float, float, float]:
    """Say where the sun stands for a wall: to its right, above, out of it."""
    out = OUTWARD[side]
    right = (-out[1], out[0])
    return (
        sun[0] * right[0] + sun[1] * right[1],
        sun[2],
        sun[0] * out[0] + sun[1] * out[1],
    )
