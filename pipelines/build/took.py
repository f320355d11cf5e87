"""How long a stage took for its elements, in a way that any runner can add up.

A runner adds counters, of however many workers, and knows no median. So each element
adds one to the counter of the span that its time fell into: ten spans a decade, from a
millisecond to a quarter of an hour. What is told of a quantile is right to an eighth.
"""

import bisect
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final, Self

PER_DECADE: Final = 10
DECADES: Final = 6
EDGES_MS: Final = tuple(
    sorted({round(10 ** (k / PER_DECADE)) for k in range(DECADES * PER_DECADE + 1)})
)
BEYOND: Final = math.inf
NAME: Final = "up_to_ms_"


def span(milliseconds: float) -> str:
    """Name the counter of the span that a time falls into."""
    at = bisect.bisect_left(EDGES_MS, milliseconds)
    return f"{NAME}{EDGES_MS[at] if at < len(EDGES_MS) else BEYOND}"


def edge(counter: str) -> float | None:
    """Read where the span of a counter ends; None if it counts something else."""
    return float(counter.removeprefix(NAME)) if counter.startswith(NAME) else None


@dataclass(frozen=True)
class Took:
    """The times of a stage's elements."""

    spans: tuple[
        tuple[float, int], ...
    ]  # where each ends (ms), and how many fell there
    longest_ms: float

    @classmethod
    def of(cls, counts: Mapping[float, int], longest_ms: float) -> Self:
        """Sort what counters tell."""
        return cls(tuple(sorted(counts.items())), longest_ms)

    @classmethod
    def read(cls, told: Mapping[str, Any]) -> Self:
        """Read back what `told` wrote."""
        counts = {float(end): int(n) for end, n in told.get("spans", {}).items()}
        return cls.of(counts, float(told.get("longest_ms", 0)))

    @property
    def count(self) -> int:
        """How many there were."""
        return sum(n for _, n in self.spans)

    def quantile_ms(self, share: float) -> float:
        """Tell a time that so large a share of the elements took at most.

        Within a span times are taken to lie evenly by their logarithms.
        """
        wanted, before = share * self.count, 0
        for end, n in self.spans:
            if n and before + n >= wanted:
                top = min(end, max(self.longest_ms, 1.0))
                low = min(start(end), top)
                return low * (top / low) ** ((wanted - before) / n)
            before += n
        return 0.0

    def told(self) -> dict[str, Any]:
        """Write it for a record of JSON."""
        return {
            "median_ms": round(self.quantile_ms(0.5)),
            "p90_ms": round(self.quantile_ms(0.9)),
            "longest_ms": round(self.longest_ms),
            "spans": {f"{end:g}": n for end, n in self.spans},
        }


def start(end: float) -> float:
    """Tell where a span begins that ends there; the first begins at half of its end."""
    at = bisect.bisect_left(EDGES_MS, end)
    return EDGES_MS[at - 1] if at else end / 2


def up_to(took: Took, edges: Iterable[float] = EDGES_MS) -> list[tuple[float, int]]:
    """Count the elements that took no longer than each edge."""
    return [(one, sum(n for end, n in took.spans if end <= one)) for one in edges]
