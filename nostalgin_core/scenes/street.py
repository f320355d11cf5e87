"""A made-up neighbourhood: blocks between streets and avenues, divided into lots.

A block is a rectangle. Four corner lots have two fronts each; between them, avenue
lots fill the short sides and street lots the long ones:

        north
     +---+--+--+---+
     | 4c|  |  |3c |      Fronts run anticlockwise seen from above: side 0 looks
     +---+--+--+---+      south, 1 east, 2 north, 3 west. Rank 0 is the western
     |   |yard |   |      end of side 0, which belongs to lot 1.
     +---+--+--+---+
     | 1c|  |  |2c |
     +---+--+--+---+
        south
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from nostalgin_core.records import Front
from nostalgin_core.scenes.lot import Lot, build

STREET_M = 21.0  # from front to front
AVENUE_M = 28.0
STREETS = ("Juniper Street", "Lantern Street", "Tinker Street", "Pewter Street")
AVENUES = ("Ferry Avenue", "Quince Avenue", "Meridian Avenue", "Harbor Avenue")


@dataclass(frozen=True, slots=True, eq=False)
class PaintedBlock:
    """One block with its lots, numbered anticlockwise from the southwest corner."""

    block: str
    corner_m: tuple[float, float, float, float]  # west, south, east, north
    lots: tuple[Lot, ...]

    @property
    def fronts(self) -> tuple[Front, ...]:
        """All its fronts round the ring, by rank."""
        found = [front for lot in self.lots for front in lot.fronts]
        return tuple(sorted(found, key=lambda front: front.rank))


@dataclass(frozen=True, slots=True, eq=False)
class Neighbourhood:
    """Blocks that are photographed, and those around them that are only seen."""

    blocks: tuple[PaintedBlock, ...]
    around: tuple[PaintedBlock, ...]
    sun: tuple[float, float, float]  # towards it: east, north, up


def neighbourhood(rng: np.random.Generator, *, blocks: int = 2) -> Neighbourhood:
    """Lay out blocks from west to east, with a ring of other blocks around them.

    Raises:
        ValueError: if there is no block to lay out, or more than streets have names.
    """
    if not 1 <= blocks < len(AVENUES):
        msg = f"blocks must be 1 to {len(AVENUES) - 1}, not {blocks}"
        raise ValueError(msg)
    azimuth, height = np.deg2rad([rng.uniform(130, 230), rng.uniform(35, 52)])
    flat = np.cos(height)
    sun = (
        float(flat * np.sin(azimuth)),
        float(flat * np.cos(azimuth)),
        float(np.sin(height)),
    )
    wides = rng.uniform(58, 74, blocks + 2)
    deeps = rng.uniform(54, 62, 3)
    wests = np.cumsum(np.append(0.0, wides[:-1] + AVENUE_M)) - wides[0] - AVENUE_M
    souths = np.cumsum(np.append(0.0, deeps[:-1] + STREET_M)) - deeps[0] - STREET_M
    made: list[PaintedBlock] = []
    around: list[PaintedBlock] = []
    for column in range(blocks + 2):
        for row in range(3):
            west, south = float(wests[column]), float(souths[row])
            corner = (
                west,
                south,
                west + float(wides[column]),
                south + float(deeps[row]),
            )
            seen = row == 1 and 1 <= column <= blocks
            name = str(2000 + column) if seen else f"{2900 + 10 * column + row}"
            block = lay_out(
                rng, name, corner, column=column, row=row, columns=blocks + 2, sun=sun
            )
            (made if seen else around).append(block)
    return Neighbourhood(archive(rng, tuple(made)), tuple(around), sun)


def archive(
    rng: np.random.Generator, blocks: tuple[PaintedBlock, ...]
) -> tuple[PaintedBlock, ...]:
    """Say how often each lot was photographed: one thrice, one twice, one in vain."""
    first, last = blocks[0], blocks[-1]
    single = [k for k, lot in enumerate(first.lots) if len(lot.fronts) == 1]
    corner = [k for k, lot in enumerate(first.lots) if len(lot.fronts) == 2]
    lots = list(first.lots)
    often = int(rng.choice(single))
    twice = int(rng.choice(corner))
    lots[often] = replace(lots[often], photos=3)
    lots[twice] = replace(lots[twice], photos=2)
    blocks = (replace(first, lots=tuple(lots)), *blocks[1:])
    last = blocks[-1]
    lots = list(last.lots)
    single = [
        k for k, lot in enumerate(lots) if len(lot.fronts) == 1 and lot.photos == 1
    ]
    fogged = int(rng.choice(single))
    lots[fogged] = replace(lots[fogged], ruined=True)
    return (*blocks[:-1], replace(last, lots=tuple(lots)))


def shares(
    rng: np.random.Generator, count: int, start: float, end: float
) -> np.ndarray:
    """Divide a length into nearly equal parts; returns the cuts, ends included."""
    parts = rng.uniform(0.8, 1.2, count)
    return start + (end - start) * np.append(0.0, np.cumsum(parts) / parts.sum())


def lay_out(
    rng: np.random.Generator,
    name: str,
    corner: tuple[float, float, float, float],
    *,
    column: int,
    row: int,
    columns: int,
    sun: tuple[float, float, float],
) -> PaintedBlock:
    """Divide a block into lots and put a building on each."""
    west, south, east, north = corner
    plots = divide(rng, corner)
    built: list[Lot] = []
    number, rank = 1, 0
    total = sum(len(sides) for _, sides in plots)
    for box, sides in plots:
        ranks = [(rank - 1 + k) % total for k in range(len(sides))]
        if len(sides) == 2 and sides[0] == 3:
            ranks = [total - 1, 0]
        elif len(sides) == 2:
            ranks = [rank, rank + 1]
        else:
            ranks = [rank]
        rank = ranks[-1] + 1
        streets = tuple(
            STREETS[(row + side // 2) % len(STREETS)]
            if side % 2 == 0
            else AVENUES[(column + (side == 1)) % len(AVENUES)]
            for side in sides
        )
        numbers = tuple(
            house_numbers(box, side, corner, columns - column) for side in sides
        )
        built.append(
            build(
                rng,
                (name, str(number)),
                box,
                tuple(zip(sides, ranks, streets, numbers, strict=True)),
                sun=sun,
                beside=built[-1].walls[0].style if built else None,
            )
        )
        number += int(rng.integers(1, 4))
    return PaintedBlock(name, (west, south, east, north), tuple(built))


def divide(
    rng: np.random.Generator, corner: tuple[float, float, float, float]
) -> list[tuple[tuple[float, float, float, float], tuple[int, ...]]]:
    """Cut a block into boxes, anticlockwise from the southwest, with their sides.

    A corner names its two sides in the order in which the ring meets them.
    """
    west, south, east, north = corner
    left, right = west + rng.uniform(14, 19), east - rng.uniform(14, 19)
    low, high = south + rng.uniform(14, 19), north - rng.uniform(14, 19)
    middle = (south + north) / 2 + rng.uniform(-2, 2)
    yard = (middle - rng.uniform(1.5, 4), middle + rng.uniform(1.5, 4))
    bottom = shares(rng, int(rng.integers(2, 4)), left, right)
    top = shares(rng, int(rng.integers(2, 4)), left, right)[::-1]
    up = shares(rng, int(rng.integers(1, 3)), low, high)
    down = shares(rng, int(rng.integers(1, 3)), low, high)[::-1]
    plots: list[tuple[tuple[float, float, float, float], tuple[int, ...]]] = []
    plots.append(((west, south, left, low), (3, 0)))
    for x0, x1 in pairwise(bottom):
        plots.append(((float(x0), south, float(x1), yard[0]), (0,)))
    plots.append(((right, south, east, low), (0, 1)))
    for y0, y1 in pairwise(up):
        plots.append(((right, float(y0), east, float(y1)), (1,)))
    plots.append(((right, high, east, north), (1, 2)))
    for x1, x0 in pairwise(top):
        plots.append(((float(x0), yard[1], float(x1), north), (2,)))
    plots.append(((west, high, left, north), (2, 3)))
    for y1, y0 in pairwise(down):
        plots.append(((west, float(y0), left, float(y1)), (3,)))
    return plots


def house_numbers(
    box: tuple[float, float, float, float],
    side: int,
    corner: tuple[float, float, float, float],
    hundred: int,
) -> str:
    """Number a front: up the avenues northwards, along the streets westwards."""
    west, south, east, north = box
    if side % 2 == 0:
        first, last = corner[2] - east, corner[2] - west
    else:
        first, last = south - corner[1], north - corner[1]
    base = 100 * hundred + (1 if side in (0, 3) else 0)
    low = base + 2 * int(first / 3.6)
    high = base + 2 * max(int(last / 3.6) - 1, int(first / 3.6))
    return str(low) if high == low else f"{low}-{high}"
