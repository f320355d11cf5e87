import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from apache_beam.metrics.cells import DistributionData, DistributionResult
from apache_beam.metrics.execution import MetricKey
from apache_beam.metrics.metricbase import MetricName

from pipelines.build.noted import note, stages
from pipelines.build.options import options
from pipelines.models import Models
from pipelines.store import Store
from pipelines.store.versions import Versions


def test_a_run_s_record_tells_its_versions_and_no_secret(tmp_path: Path) -> None:
    words = [
        "--s3_secret_access_key=hush",
        "--s3_access_key_id=hush",
        "--job_name=ours",
    ]
    store, versions = Store(str(tmp_path)), Versions.present(Models())
    note(store, "run", versions, options(str(tmp_path), beam=words), 0.0)
    told = (tmp_path / "runs/run/run.json").read_text()
    assert "hush" not in told
    assert json.loads(told)["options"]["job_name"] == "ours"
    assert Versions(**json.loads(told)["versions"]) == versions


def test_a_distribution_that_nobody_updated_is_no_failure() -> None:
    name = MetricName("segment", "worker_mb")
    empty = DistributionResult(DistributionData(0, 0, None, None))
    for result in (empty, None):
        key = MetricKey("Segment", name)
        told = SimpleNamespace(key=key, result=result)
        found = {"counters": [], "distributions": [told]}
        metrics = SimpleNamespace(query=lambda found=found: found)
        ran: Any = SimpleNamespace(metrics=lambda metrics=metrics: metrics)
        assert stages(ran)["segment"]["worker_mb"] == 0
