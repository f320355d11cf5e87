"""The longest run of house numbers that rises with the lots, and who is not in it.

Numbers are ranges; each must lie wholly above the one before. The longest run is found
by patience sorting in n log n (Fredman, On computing the length of longest increasing
subsequences, 1975), from both ends: what is in no longest run certainly stands out, and
what is in some of them only contradicts another that may be wrong as well.
"""

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass

Ranges = Sequence[tuple[float, float]]


@dataclass(frozen=True, slots=True)
class Run:
    """How some numbers rise (1) or fall (-1) in the order of their lots."""

    direction: int
    length: int
    out: tuple[int, ...]  # in no longest run
    doubtful: tuple[int, ...]  # in some longest runs, not in all


def runs(ranges: Ranges) -> tuple[Run, Run]:
    """Find the longest rising run and the longest falling one."""
    falling = [(-high, -low) for low, high in ranges]
    return Run(1, *_rising(ranges)), Run(-1, *_rising(falling))


def _rising(ranges: Ranges) -> tuple[int, tuple[int, ...], tuple[int, ...]]:
    before = _lengths(ranges)
    after = _lengths([(-high, -low) for low, high in reversed(ranges)])[::-1]
    longest = max(before, default=0)
    levels: dict[int, list[int]] = {}
    out = []
    for place, (a, b) in enumerate(zip(before, after, strict=True)):
        if a + b - 1 == longest:
            levels.setdefault(a, []).append(place)
        else:
            out.append(place)
    doubtful = [place for some in levels.values() if len(some) > 1 for place in some]
    return longest, tuple(out), tuple(sorted(doubtful))


def _lengths(ranges: Ranges) -> list[int]:
    """Tell how long a rising run may end with each range."""
    ends: list[float] = []  # the lowest end of a run of each length
    lengths = []
    for low, high in ranges:
        place = bisect_left(ends, low)
        lengths.append(place + 1)
        if place == len(ends):
            ends.append(high)
        else:
            ends[place] = min(ends[place], high)
    return lengths
