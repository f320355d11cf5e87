"""How placing grows with a city: python tests/bench/bench_places.py [1000 3000 10000].

A town of numbered streets and avenues is laid out by its streets alone. Each time is
told as a ratio to the smallest town's, with the exponent p of n^p between neighbours:
n log n has about 1.1 here, a loop over pairs 2.
"""

import math
import sys
import time
from dataclasses import replace

import numpy as np

from nostalgin_core import city
from nostalgin_core.city.plot import Border, Plot

SIZES = (1000, 3000, 10_000)
WIDE_M, DEEP_M = 250.0, 60.0


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


if __name__ == "__main__":
    main([int(one) for one in sys.argv[1:]] or list(SIZES))
