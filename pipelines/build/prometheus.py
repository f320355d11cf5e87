"""What a run came to, as text for Prometheus: one file for its textfile collector.

The collector reads the text format 0.0.4 alone, to which OpenMetrics' counters have no
type; Prometheus's own library writes it from what run.json tells. The counters are of
one run, and begin anew with the next: their `_created` times tell so.
"""

import time
from calendar import timegm
from collections.abc import Iterator, Mapping
from typing import Any, Final

from prometheus_client import CollectorRegistry, generate_latest
from prometheus_client.core import (
    CounterMetricFamily,
    GaugeMetricFamily,
    HistogramMetricFamily,
    Metric,
)

from pipelines.build.took import EDGES_MS, Took, up_to
from pipelines.store import Store

FILE: Final = "metrics.prom"
PACE: Final = "rectify"  # by which stage photos a minute are counted
CLOCK: Final = "%Y-%m-%dT%H:%M:%SZ"
COUNTERS: Final = {
    "made": "What a stage gave; rectify gives several facades a photo.",
    "skipped": "Elements whose artifacts were there already.",
    "rejected": "What a stage declined, crashes among them.",
    "crashed": "Elements at which a stage crashed.",
    "healed": "Damaged artifacts that were made again.",
}
Told = Mapping[str, Any]  # as run.json has it


def write(store: Store, told: Told, shard: str, *, succeeded: Told) -> None:
    """Write the metrics of a run that is done; `succeeded` is the last published one.

    Each shard has a file of its own, so that none replaces another's.
    """
    name = FILE
    if shard:
        name = f"metrics.{shard.replace('/', '-of-')}.prom"
    city = store.root.rstrip("/").rpartition("/")[2]
    store.write_bytes(name, text(told, city, shard, succeeded=succeeded))


def text(told: Told, city: str, shard: str, *, succeeded: Told) -> bytes:
    """Write a run's metrics in Prometheus's text format 0.0.4."""
    registry = CollectorRegistry()
    registry.register(Collected(list(metrics(told, city, shard, succeeded))))
    return generate_latest(registry)


class Collected:
    """Metrics that the library asks for when it writes."""

    def __init__(self, families: list[Metric]) -> None:
        """Hold them."""
        self._families = families

    def collect(self) -> list[Metric]:
        """Give them."""
        return self._families


def metrics(told: Told, city: str, shard: str, succeeded: Told) -> Iterator[Metric]:
    """Give all that is known of a run."""
    whose, began = [city, shard], epoch_s(told)
    stages: Mapping[str, Told] = told.get("stages", {})
    for word, what in COUNTERS.items():
        counter = CounterMetricFamily(
            f"nostalgin_{word}", what, labels=["city", "shard", "stage"]
        )
        for stage, one in sorted(stages.items()):
            counter.add_metric([*whose, stage], one.get(word, 0), created=began)
        yield counter
    yield durations(stages, whose)
    yield memory(told.get("memory_mb", {}), whose)
    seconds, done = told.get("seconds", 0.0), Took.read(stages.get(PACE, {})).count
    for name, what, value in (
        ("run_seconds", "How long the last run took.", seconds),
        ("photos_per_minute", "Photos rectified.", 60 * done / max(seconds, 1e-9)),
        ("last_run_timestamp_seconds", "When it ended.", began + seconds),
        (
            "last_success_timestamp_seconds",
            "When the run ended whose city is shown; 0: none is.",
            epoch_s(succeeded) + succeeded.get("seconds", 0.0),
        ),
    ):
        gauge = GaugeMetricFamily(f"nostalgin_{name}", what, labels=["city", "shard"])
        gauge.add_metric(whose, value)
        yield gauge


def durations(stages: Mapping[str, Told], whose: list[str]) -> Metric:
    """Give how long elements took, stage by stage, but for those that were skipped."""
    made = HistogramMetricFamily(
        "nostalgin_stage_seconds",
        "Time of a stage for one element.",
        labels=["city", "shard", "stage"],
    )
    for stage, one in sorted(stages.items()):
        took = Took.read(one)
        buckets = [(f"{end / 1000:g}", n) for end, n in up_to(took, EDGES_MS)]
        spent = one.get("milliseconds", 0) / 1000
        every = [*buckets, ("+Inf", took.count)]
        made.add_metric([*whose, stage], buckets=every, sum_value=spent)
    return made


def memory(told: Told, whose: list[str]) -> Metric:
    """Give the most memory that a process of each kind has held."""
    made = GaugeMetricFamily(
        "nostalgin_memory_peak_bytes",
        "The most that a process held: the driver, a worker, a stage's own process.",
        labels=["city", "shard", "process"],
    )
    for process, megabytes in sorted(told.items()):
        made.add_metric([*whose, process], megabytes * 1e6)
    return made


def epoch_s(told: Told) -> float:
    """Tell when a run began, in seconds since 1970; 0 if it does not tell."""
    try:
        return float(timegm(time.strptime(str(told.get("began", "")), CLOCK)))
    except ValueError:
        return 0.0
