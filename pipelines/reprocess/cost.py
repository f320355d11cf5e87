"""What work is estimated to cost, from what earlier runs of the city measured."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from pipelines.store import Store
from pipelines.store.refuse import record

# What a stage's artifacts are counted by: its own results, but `rectify` gives facades.
ELEMENTS: Final = {
    "segment": "segment",
    "matte": "matte",
    "rectify": "matte",
    "thumbnail": "thumbnail",
    "borrow": "borrow",
    "inpaint": "inpaint",
    "block": "block",
}


@dataclass(frozen=True)
class Rates:
    """CPU seconds an artifact, and how these became seconds on the clock."""

    cpu_s: dict[str, float]  # by stage
    wall_per_cpu: float  # of one worker
    facades: float  # finished ones, of one photograph

    def cpu(self, made: Mapping[str, float]) -> float:
        """Estimate the CPU seconds of so many artifacts a stage."""
        return sum(self.cpu_s.get(stage, 0.0) * n for stage, n in made.items())


def rates(store: Store) -> Rates | None:
    """Take each stage's time from the run that spent most on it; None: none tells.

    A run that found its artifacts made counts them, too, and spent nothing.
    """
    told = [one for run in store.names("runs") if (one := record(store, run))]
    best: dict[str, tuple[float, float]] = {}
    longest: tuple[float, float] = (0.0, 1.0)
    facades = 1.0
    for one in told:
        stages = one.get("stages") or {}
        whole = 0.0
        for stage, of in ELEMENTS.items():
            spent = number(stages, stage, "cpu_milliseconds") / 1000
            count = number(stages, of, "made") or 1.0
            whole += spent
            if spent > best.get(stage, (0.0, 0.0))[0]:
                best[stage] = (spent, spent / count)
        if whole > longest[0] and isinstance(one.get("seconds"), (int, float)):
            longest = (whole, one["seconds"] * workers(one) / whole)
            photos = number(stages, "segment", "made") or 1.0
            facades = number(stages, "inpaint", "made") / photos
    if not best:
        return None
    return Rates({s: each for s, (_, each) in best.items()}, longest[1], facades)


def number(stages: Mapping[str, Any], stage: str, name: str) -> float:
    """Read a stage's figure; 0 if it tells none."""
    told = (stages.get(stage) or {}).get(name, 0)
    return float(told) if isinstance(told, (int, float)) else 0.0


def workers(told: Mapping[str, Any]) -> int:
    """Read how many processes a run had."""
    given = str((told.get("options") or {}).get("direct_num_workers", "1"))
    return max(int(given), 1) if given.isdecimal() else 1
