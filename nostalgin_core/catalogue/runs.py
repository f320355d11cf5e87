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

    direction: int  # 0: as many say one as say the other
    length: int
    out: tuple[int, ...]  # in no longest run
    doubtful: tuple[int, ...]  # in some longest runs, not in all


def run(ranges: Ranges) -> Run:
    """Find the longer of the longest rising and the longest falling run."""
    up, down = _rising(ranges), _rising([(-high, -low) for low, high in ranges])
    if up.length != down.length:
        return Run(1, *up.rest()) if up.length > down.length else Run(-1, *down.rest())
    votes = 0
    for place, (low, high) in enumerate(ranges[: min(len(ranges), 64)]):
        for after, below in ranges[place + 1 : 64]:
            votes += (after > high) - (below < low)
    if votes:
        return Run(1, *up.rest()) if votes > 0 else Run(-1, *down.rest())
    return Run(0, *up.rest())


@dataclass(frozen=True, slots=True)
class _Longest:
    length: int
    out: tuple[int, ...]
    doubtful: tuple[int, ...]

    def rest(self) -> tuple[int, tuple[int, ...], tuple[int, ...]]:
        return self.length, self.out, self.doubtful


def _rising(ranges: Ranges) -> _Longest:
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
    return _Longest(longest, tuple(out), tuple(sorted(doubtful)))


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
