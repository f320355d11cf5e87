"""How far a build has come, told while it runs.

A stage has done as many photos as it has artifacts, wherever its workers are: so the
watcher counts these, and asks no runner. A city folder holds artifacts of other photos,
too, and no name tells whose one is: so people hear what was made since the run began.
What is left is weighed by what stages cost.
"""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from types import TracebackType
from typing import Any, Final, Self

from pipelines import plural
from pipelines.console.voice import Voice

PACE: Final = "rectify"  # by which stage photos a minute are counted
# What an artifact costs, relative to others: CPU seconds of 99 tax photographs.
# A block's facades are compared in one artifact, which tells of no pace.
WEIGHTS: Final = {
    "segment": 0.76,
    "matte": 0.46,
    "rectify": 0.36,
    "borrow": 0.49,
    "inpaint": 1.0,
}
# Facades a photo that a wall wears, of these those that another photo shows as well.
SELDOM: Final = {"borrow": 0.54, "inpaint": 0.85}
ONE_EACH: Final = ("segment", "matte", "rectify")  # an artifact a photo, at most
EVERY_S: Final = 2.0  # a photo takes seconds
SAY_EVERY_S: Final = 30.0  # without a terminal every line stays
REST: Final = 20.0  # times as long as a look takes: a store may hold a million files


@dataclass
class Watch:
    """Watches artifacts being made while a block of code runs, and tells of it."""

    voice: Voice
    count: Callable[[], dict[str, int]]  # the artifacts of each stage, in their order
    photos: int
    _stop: threading.Event = field(default_factory=threading.Event)
    _thread: threading.Thread | None = None
    _look_s: float = 0.0

    def __enter__(self) -> Self:
        """Start to watch."""
        self._thread = threading.Thread(target=self._loop, daemon=True)
        self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Stop."""
        self._stop.set()
        if self._thread is not None:
            self._thread.join()

    def _loop(self) -> None:
        began, before = time.monotonic(), self._looked()
        terminal = self.voice.console.is_terminal and not self.voice.machine
        every = EVERY_S if terminal else SAY_EVERY_S
        tell = self._status if terminal else self._lines
        tell(lambda: self._facts(before, time.monotonic() - began), every)

    def _status(self, facts: Callable[[], dict[str, Any]], every: float) -> None:
        with self.voice.console.status("starting") as status:
            while not self._stopped(every):
                status.update(self._text(facts()))

    def _lines(self, facts: Callable[[], dict[str, Any]], every: float) -> None:
        while not self._stopped(every):
            now = facts()
            self.voice.say("progress", self._text(now), **now)

    def _stopped(self, every: float) -> bool:
        return self._stop.wait(max(every, REST * self._look_s))

    def _looked(self) -> dict[str, int]:
        began = time.monotonic()
        now = self.count()
        self._look_s = time.monotonic() - began
        return now

    def _facts(self, before: dict[str, int], seconds: float) -> dict[str, Any]:
        now = self._looked()
        new = {stage: max(now[stage] - before[stage], 0) for stage in now}
        rate = 60 * new[PACE] / max(seconds, 1e-9)
        return {
            "photos": self.photos,
            "there": now,
            "new": new,
            "photos_per_minute": round(rate, 1),
            "seconds_left": left_s(now, new, self.photos, seconds),
        }

    def _text(self, facts: dict[str, Any]) -> str:
        parts = [f"{stage} {done}" for stage, done in facts["new"].items()]
        rate, left = facts["photos_per_minute"], facts["seconds_left"]
        photos = plural.of(self.photos, "photo")
        words = f"{photos}; made since the start: {', '.join(parts)}"
        words = f"{words}; {rate} photos a minute"
        return words if left is None else f"{words}, about {spelled(left)} left"


def left_s(
    now: dict[str, int], new: dict[str, int], photos: int, seconds: float
) -> int | None:
    """Tell how long what lacks will take, at the pace so far; None: nobody knows.

    So it is while nothing was done, and where the store holds more than these photos
    can have given: what lacks of them is not told then. Fewer artifacts of others, of
    other shards for one, are not noticed, and make it less.
    """
    if any(now.get(stage, 0) > photos for stage in ONE_EACH):
        return None
    done = sum(weight * new.get(stage, 0) for stage, weight in WEIGHTS.items())
    wanted = {stage: SELDOM.get(stage, 1.0) * photos for stage in WEIGHTS}
    lacks = sum(
        weight * max(wanted[stage] - now.get(stage, 0), 0)
        for stage, weight in WEIGHTS.items()
    )
    return round(seconds * lacks / done) if done else None


def spelled(seconds: int) -> str:
    """Tell a time as people do."""
    minutes = round(seconds / 60)
    if minutes < 1:
        return "a minute"
    return f"{minutes} min" if minutes < 120 else f"{round(minutes / 60)} h"
