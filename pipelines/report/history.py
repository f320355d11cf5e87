"""The runs of a city folder: when they were, what they took, how they ended."""

import json
from dataclasses import dataclass
from typing import Any, Final

from pipelines.store import Store, runs

RUN: Final = "run.json"


@dataclass(frozen=True)
class Past:
    """One run, as its own files tell it."""

    run: str
    began: str  # UTC, as 2026-11-22T22:28:22Z; "" where nothing tells
    seconds: float | None  # None: it did not come to its end, or is at work still
    photos: int | None  # None: it was not published
    shown_share: float | None
    current: bool  # its city is the one that is shown
    cpu_seconds: float | None = None  # that its stages spent
    estimated_cpu_seconds: float | None = None  # as it was planned, if it was

    @property
    def state(self) -> str:
        """Tell how it ended."""
        if self.current:
            return "shown"
        if self.seconds is None:
            return "unfinished"
        return "finished" if self.photos is None else "replaced"


def history(store: Store) -> list[Past]:
    """List a city's runs, the oldest first; files that make no sense tell nothing."""
    shown = current(store)
    pasts = [past(store, run, shown) for run in store.names("runs")]
    return sorted(pasts, key=lambda one: (one.began, one.run))


def current(store: Store) -> str:
    """Name the run whose city is shown; "" if there is none."""
    try:
        return runs.shown(store)
    except (OSError, ValueError):
        return ""


def past(store: Store, run: str, shown: str) -> Past:
    """Read what one run's folder tells."""
    told = read_json(store, f"runs/{run}/{RUN}")
    published = read_json(store, f"runs/{run}/{runs.PUBLISHED}")
    return Past(
        run=run,
        began=str(told.get("began", "")),
        seconds=number(told.get("seconds")),
        photos=None if published.get("photos") is None else int(published["photos"]),
        shown_share=number(published.get("shown_share")),
        current=run == shown,
        cpu_seconds=number(told.get("cpu_seconds")),
        estimated_cpu_seconds=estimated(told.get("estimated")),
    )


def estimated(told: object) -> float | None:
    """Read what a run was estimated to cost."""
    return number(told.get("cpu_seconds")) if isinstance(told, dict) else None


def read_json(store: Store, name: str) -> dict[str, Any]:
    """Read an object of JSON; an empty one where there is none."""
    try:
        told = json.loads(store.read_bytes(name))
    except (OSError, ValueError):
        return {}
    return told if isinstance(told, dict) else {}


def number(told: object) -> float | None:
    """Take a number for one, and all else for none."""
    return float(told) if isinstance(told, int | float) else None
