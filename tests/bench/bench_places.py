"""How placing grows with a city: python tests/bench/bench_places.py [1000 3000 10000].

A town of numbered streets and avenues is laid out by its streets alone. Each time is
told as a ratio to the smallest town's, with the exponent p of n^p between neighbours:
n log n has about 1.1 here, a loop over pairs 2.

Then the smallest town is laid into ragged outlines of its blocks, with streets in
common and without (so that all four quarter turns are tried). Baseline: the same by the
tests' slow oracle, a turn at a time.
"""

import math
import sys
import time
from dataclasses import replace
from unittest.mock import patch

import numpy as np
import shapely

from nostalgin_core import city
from nostalgin_core.city import anchor
from nostalgin_core.city.globe import Plane
from nostalgin_core.city.plot import Border, Move, Plot, carried
from nostalgin_core.city.tileset import Place
from tests.core.city.plain_fit import plain_fit

SIZES = (1000, 3000, 10_000)
WIDE_M, DEEP_M = 250.0, 60.0
HOUSE_M = 7.0  # an outline has a point a house
RAGGED_M = 0.4
TURNED = Move(0.5)
NEW_YORK = Plane(Place(-73.98, 40.75))


def town(count: int) -> list[Plot]:
    """Lay out a square town; house numbers rise by 100 a block, as in New York."""
    side = math.ceil(math.sqrt(count))
    corners = np.array([[0, 0], [WIDE_M, 0], [WIDE_M, DEEP_M], [0, DEEP_M]])
    plots = []
    for index in range(count):
        north, east = divmod(index, side)
        streets = (
            f"{north} street",
            f"{east + 1} avenue",
            f"{north + 1} street",
            f"{east} avenue",
        )
        x, y = 100 * east, 20 * north
        numbers = ((x + 1, x + 61), (y + 1, y + 13), (x + 62, x + 2), (y + 14, y + 2))
        plain = Border("", "", "", corners[0], corners[1], None)
        borders = tuple(
            replace(
                plain,
                street=streets[at],
                before=streets[at - 1],
                after=streets[(at + 1) % 4],
                start_m=corners[at],
                end_m=corners[(at + 1) % 4],
                numbers=numbers[at],
            )
            for at in range(4)
        )
        plots.append(Plot(str(index), (corners,), borders))
    return plots


def outlined(plots: list[Plot]) -> dict[str, anchor.Anchor]:
    """Draw the outline of each block where it goes, ragged as houses make it."""
    rng, there = np.random.default_rng(0), city.places(plots)
    anchors = {}
    for one in plots:
        ring = shapely.LinearRing(
            carried(TURNED, carried(there[one.block], one.outlines_m[0]))
        )
        spots = ring.interpolate(np.arange(0.0, ring.length, HOUSE_M))
        points = shapely.get_coordinates(spots)
        points += rng.normal(0.0, RAGGED_M, points.shape)
        degrees = NEW_YORK.degrees(points)
        longitude, latitude = degrees.mean(axis=0)
        anchors[one.block] = anchor.Anchor(
            float(longitude), float(latitude), outline_deg=(degrees,)
        )
    return anchors


def alone(one: Plot) -> Plot:
    """Rename a block's streets, so that it shares none."""
    borders = tuple(replace(b, street=f"{one.block} {b.street}") for b in one.borders)
    return replace(one, borders=borders)


def by_outlines(plots: list[Plot]) -> None:
    """Print what a block costs that lies in its outline, both ways."""
    anchors = outlined(plots)
    print(f"{len(plots)} blocks in outlines   ms/block   slow oracle   ratio")
    for words, blocks in (
        ("streets in common", plots),
        ("no street in common", [alone(one) for one in plots]),
    ):
        took = []
        for fitted in (anchor.fit, plain_fit):
            with patch.object(anchor, "fit", fitted):
                began = time.process_time()
                anchor.anchored(blocks, anchors)
                took.append(1000 * (time.process_time() - began) / len(plots))
        print(f"{words:23} {took[0]:10.2f} {took[1]:13.2f} {took[1] / took[0]:7.2f}")


def main(sizes: list[int]) -> None:
    """Print a row a size."""
    before: tuple[int, float] | None = None
    base = 0.0
    print(f"{'blocks':>8} {'seconds':>8} {'ratio':>7} {'p':>6}")
    for count in sizes:
        plots = town(count)
        began = time.process_time()
        city.places(plots)
        took = time.process_time() - began
        base = base or took
        power = (
            math.log(took / before[1]) / math.log(count / before[0]) if before else 0.0
        )
        print(f"{count:8d} {took:8.2f} {took / base:7.2f} {power:6.2f}", flush=True)
        before = (count, took)
    by_outlines(town(sizes[0]))


if __name__ == "__main__":
    main([int(one) for one in sys.argv[1:]] or list(SIZES))
