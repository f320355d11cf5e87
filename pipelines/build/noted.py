"""When a run was and what it took: the one file with clock times."""

import json
import re
import time
from typing import Any, Final

from apache_beam.options.pipeline_options import PipelineOptions
from apache_beam.runners.runner import PipelineResult

from pipelines.store import Store
from pipelines.store.versions import Versions

SECRET: Final = re.compile("key|secret|token|passw|credential")  # in options' names


def note(
    store: Store,
    run: str,
    versions: Versions,
    options: PipelineOptions,
    began: float,
    *,
    done: dict[str, dict[str, int]] | None = None,
) -> None:
    """Write when the run was and what it took: the only file with clock times.

    Until the run is done it tells only when it began.
    """
    given = options.get_all_options(drop_default=True)
    told: dict[str, Any] = {
        "run": run,
        "versions": vars(versions),
        "began": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(began)),
        "options": {
            name: "(not told)" if SECRET.search(name) else str(value)
            for name, value in given.items()
        },
    }
    if done is not None:
        told |= {"seconds": round(time.time() - began, 1), "stages": done}
    text = json.dumps(told, indent=1, sort_keys=True) + "\n"
    store.write_bytes(f"runs/{run}/run.json", text.encode())


def stages(result: PipelineResult) -> dict[str, dict[str, int]]:
    """Read the counters and times of all stages."""
    metrics = result.metrics().query()
    told: dict[str, dict[str, int]] = {}
    for one in metrics["counters"]:
        mine = told.setdefault(one.key.metric.namespace, {})
        mine[one.key.metric.name] = mine.get(one.key.metric.name, 0) + (
            one.result or 0  # Prism says None of what it did not count
        )
    for one in metrics["distributions"]:
        mine = told.setdefault(one.key.metric.namespace, {})
        spent = one.result.sum if one.result is not None else 0
        mine["milliseconds"] = mine.get("milliseconds", 0) + spent
    return told
