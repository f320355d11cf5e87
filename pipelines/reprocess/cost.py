"""What work is estimated to cost, from what earlier runs of the city measured.

A run tells of each stage what CPU seconds it spent and how many elements it worked on
(`took`); what was found made is in neither. A stage's rate is the median over the runs,
each as heavy as its elements are many: one run on a busy machine moves it little, and
so does one that redid a single photograph.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from pipelines.build import Took
from pipelines.store import Store
from pipelines.store.refuse import record

STAGES: Final = (
    *("segment", "matte", "rectify", "thumbnail"),  # an element is a photograph
    *("borrow", "inpaint"),  # a front that wears one
    *("assign", "block"),  # a block; to assign is to compare its facades, too
)
OF_PHOTO: Final = ("borrow", "inpaint")  # follow from photographs, some of each


@dataclass(frozen=True)
class Rates:
    """What an element of each stage costs, and what comes of a photograph."""

    cpu_s: Mapping[str, float]  # by stage
    of_photo: Mapping[str, float]  # elements of later stages, of one photograph
    runs: Sequence[tuple[float, float]] = field(default=())  # CPU s, clock s by worker

    def cpu(self, elements: Mapping[str, float]) -> float:
        """Estimate the CPU seconds of so many elements a stage."""
        return sum(self.cpu_s.get(stage, 0.0) * n for stage, n in elements.items())

    def clock(self, cpu_s: float, workers: int) -> float:
        """Estimate the time on the clock, as it was in the run that is most alike.

        What starts, plans and publishes counts the more, the less there is to do.
        """
        if not self.runs or not cpu_s:
            return cpu_s / workers
        spent, took = min(self.runs, key=lambda one: abs(np.log(one[0] / cpu_s)))
        return cpu_s * took / spent / workers


def rates(store: Store) -> Rates | None:
    """Read what all kept runs tell; None if none tells of any work."""
    told = [one for run in store.names("runs") if (one := record(store, run))]
    samples: dict[str, list[tuple[float, float]]] = {stage: [] for stage in STAGES}
    ratios: dict[str, list[tuple[float, float]]] = {stage: [] for stage in OF_PHOTO}
    runs: list[tuple[float, float]] = []
    for one in told:
        stages = one.get("stages")
        counts = {stage: elements(stages, stage) for stage in STAGES}
        for stage, n in counts.items():
            if n:
                samples[stage].append((spent_s(stages, [stage]) / n, n))
        photos = counts["segment"]
        for stage in OF_PHOTO if photos else ():
            ratios[stage].append((counts[stage] / photos, photos))
        whole = spent_s(stages, STAGES)
        if whole and isinstance(one.get("seconds"), (int, float)):
            runs.append((whole, one["seconds"] * workers(one)))
    if not any(samples.values()):
        return None
    return Rates(
        {stage: middle(some) for stage, some in samples.items() if some},
        {stage: middle(some) for stage, some in ratios.items() if some},
        runs,
    )


def middle(samples: Iterable[tuple[float, float]]) -> float:
    """Take the median of values, each with its weight."""
    values, weights = np.array(sorted(samples)).T
    half = weights.sum() / 2
    return float(values[np.searchsorted(np.cumsum(weights), half)])


def elements(stages: Any, stage: str) -> int:
    """Count what a stage worked on; 0 if the record makes no sense."""
    try:
        return Took.read(stages[stage]).count
    except (KeyError, TypeError, ValueError, AttributeError):
        return 0


def spent_s(stages: Any, names: Iterable[str]) -> float:
    """Sum the CPU seconds of some stages; 0 of what makes no sense."""
    spent = 0.0
    for name in names:
        told = stages.get(name) if isinstance(stages, dict) else None
        one = told.get("cpu_milliseconds") if isinstance(told, dict) else None
        spent += one / 1000 if isinstance(one, (int, float)) else 0.0
    return spent


def workers(told: Mapping[str, Any]) -> int:
    """Read how many processes a run had."""
    given = str((told.get("options") or {}).get("direct_num_workers", "1"))
    return max(int(given), 1) if given.isdecimal() else 1
