"""When a run was and what it took: run.json, for people and for later runs.

Clock times stand there and in `metrics.prom`, which is written of it, alone.
"""

import json
import re
import time
from collections.abc import Iterable, Mapping
from typing import Any, Final

from apache_beam.options.pipeline_options import PipelineOptions
from apache_beam.runners.runner import PipelineResult

from pipelines.build.supervisor import peak_mb
from pipelines.build.took import Took, edge
from pipelines.store import Store
from pipelines.store.versions import Versions

SECRET: Final = re.compile("key|secret|token|passw|credential")  # in options' names
# In their values: a name of a secret, and then what it is, as in JSON or a URI.
TELLING: Final = re.compile(
    r"(key|secret|token|passw\w*|credential)\w*[\"']?\s*[:=]|://[^/\s]*@", re.IGNORECASE
)
UNTOLD: Final = "(not told)"
PEAKS: Final = ("worker_mb", "stage_mb")  # of memory, as distributions


def note(
    store: Store,
    run: str,
    versions: Versions,
    options: PipelineOptions,
    began: float,
    *,
    told_of: Mapping[str, Any] | None = None,
    done: dict[str, dict[str, Any]] | None = None,
) -> dict[str, Any]:
    """Write when the run was and what it took, and give what was written.

    Until the run is done it tells only when it began. `told_of` are hashes of what it
    was told, and what it was estimated to cost.
    """
    given = options.get_all_options(drop_default=True)
    told: dict[str, Any] = {
        "run": run,
        "versions": vars(versions),
        **(told_of or {}),
        "began": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(began)),
        "options": {name: harmless(name, str(value)) for name, value in given.items()},
    }
    if done is not None:
        told |= {"seconds": round(time.time() - began, 1), "stages": done}
        told["memory_mb"] = memory_mb(done.values())
        told["cpu_seconds"] = cpu_s(done.values())
    text = json.dumps(told, indent=1, sort_keys=True) + "\n"
    store.write_bytes(f"runs/{run}/run.json", text.encode())
    return told


def harmless(name: str, value: str) -> str:
    """Tell an option's value, unless it may be a secret."""
    return UNTOLD if SECRET.search(name) or TELLING.search(value) else value


def cpu_s(stages: Iterable[dict[str, Any]]) -> float:
    """Sum up the CPU seconds of all stages."""
    return round(sum(one.get("cpu_milliseconds", 0) for one in stages) / 1000, 1)


def memory_mb(stages: Iterable[dict[str, Any]]) -> dict[str, int]:
    """Tell the most that the driver, a worker and a stage's own process have held."""
    every = list(stages)
    most = {one: max((s.get(one, 0) for s in every), default=0) for one in PEAKS}
    return {
        "driver": round(peak_mb()),
        "worker": most["worker_mb"],
        "stage": most["stage_mb"],
    }


def stages(*results: PipelineResult) -> dict[str, dict[str, Any]]:
    """Read the counters, times and memory of all stages, of a run's pipelines."""
    metrics: dict[str, list[Any]] = {"counters": [], "distributions": []}
    for result in results:
        found = result.metrics().query()
        for kind, so_far in metrics.items():
            so_far.extend(found[kind])
    told: dict[str, dict[str, Any]] = {}
    spans: dict[str, dict[float, int]] = {}
    for one in metrics["counters"]:
        stage, name = one.key.metric.namespace, one.key.metric.name
        count, end = one.result or 0, edge(name)  # Prism says None of what it lacks
        mine: dict[Any, Any] = told.setdefault(stage, {})
        if end is not None:
            mine, name = spans.setdefault(stage, {}), end
        mine[name] = mine.get(name, 0) + count
    for one in metrics["distributions"]:
        mine, name = told.setdefault(one.key.metric.namespace, {}), one.key.metric.name
        of = one.result  # None, or its `max` is, of what was never updated
        spent, most = (of.sum or 0, of.max or 0) if of is not None else (0, 0)
        if name in PEAKS:
            mine[name] = max(mine.get(name, 0), most)
            continue
        mine[name] = mine.get(name, 0) + spent
        mine["longest_ms"] = max(mine.get("longest_ms", 0), most)
    for stage, mine in told.items():
        mine.setdefault("milliseconds", 0)  # where all was skipped
        took = Took.of(spans.get(stage, {}), mine.get("longest_ms", 0))
        mine.update(took.told())
    return told
