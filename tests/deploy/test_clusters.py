"""What `deploy/` starts on clusters: every shard once, by options that are known."""

import os
import re
import shlex
import subprocess
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import apache_beam as beam
import pytest
import yaml
from apache_beam.options.pipeline_options import (
    PipelineOptions,
    PortableOptions,
)
from apache_beam.portability import common_urns
from apache_beam.portability.api import beam_runner_api_pb2
from apache_beam.transforms.environments import Environment

from pipelines.build.options import options, part
from pipelines.schedule import ticks_between
from tests.data import ROOT

NOW = datetime(2026, 11, 23, tzinfo=UTC)
DEPLOY = ROOT / "deploy"
SBATCH = """#!/bin/sh
printf '%s\\n' "$@" --- >> "$SAID"
echo 42
"""


def test_the_slurm_script_starts_each_shard_and_then_the_last_run(
    tmp_path: Path,
) -> None:
    said = tmp_path / "said"
    (tmp_path / "sbatch").write_text(SBATCH)
    (tmp_path / "sbatch").chmod(0o755)
    env = {"PATH": f"{tmp_path}:{os.environ['PATH']}", "SAID": str(said), "CITY": "/c"}
    subprocess.run([DEPLOY / "slurm/city.sh", "16"], env=env, check=True)
    array, last = [one.split("\n") for one in said.read_text().split("---\n")[:2]]
    assert "--array=1-16" in array
    assert '"$SLURM_ARRAY_TASK_ID/16"' in "\n".join(array)
    assert "--dependency=afterany:42" in last
    assert "--shard" not in "\n".join(last)


def documents() -> list[Any]:
    files = sorted((DEPLOY / "kubernetes").glob("*.yaml"))
    return [one for file in files for one in yaml.safe_load_all(file.read_text())]


def test_the_kubernetes_job_has_an_index_for_each_of_its_shards() -> None:
    (job,) = [d for d in documents() if d["metadata"]["name"] == "nostalgin-shards"]
    (container,) = job["spec"]["template"]["spec"]["containers"]
    (command,) = container["args"]
    assert job["spec"]["completionMode"] == "Indexed"
    count = job["spec"]["completions"]
    for index in range(count):
        env = {"JOB_COMPLETION_INDEX": str(index), "CITY": "c"}
        shown = command.replace("exec nostalgin", "echo")
        done = subprocess.check_output(["/bin/sh", "-c", shown], env=env, text=True)
        words = shlex.split(done)
        assert part(words[words.index("--shard") + 1]) == (index + 1, count)


def test_the_cron_job_and_its_command_name_the_same_times() -> None:
    (job,) = [d for d in documents() if d["kind"] == "CronJob"]
    spec = job["spec"]
    (container,) = spec["jobTemplate"]["spec"]["template"]["spec"]["containers"]
    words = container["command"]
    assert f"--cron={spec['schedule']}" in words
    assert f"--zone={spec['timeZone']}" in words
    assert "--once" in words
    assert spec["concurrencyPolicy"] == "Forbid"
    ticks_between(spec["schedule"], spec["timeZone"], NOW, NOW)


def test_flink_is_told_of_external_workers_and_of_retries() -> None:
    text = (DEPLOY / "kubernetes/flink.yaml").read_text()
    told = re.findall(r"--(?!runner|job|flink|port)\w+=[^\s\\\]\"]+", text)
    made = options("c", beam=["--runner=PortableRunner", *told])
    portable = made.view_as(PortableOptions)
    assert portable.environment_type == "EXTERNAL"
    sent = made.get_all_options(retain_unknown_options=True)  # as to a job server
    assert str(sent["number_of_execution_retries"]) == "3"
    assert str(sent["parallelism"]) == "8"
    environment = proto(made)
    assert environment.urn == common_urns.environments.EXTERNAL.urn
    payload = beam_runner_api_pb2.ExternalPayload.FromString(environment.payload)
    assert payload.endpoint.url == portable.environment_config


def proto(made: PipelineOptions) -> Any:
    """Give the environment that a runner of another process is told of."""
    portable = made.view_as(PortableOptions)
    kind = Environment.get_env_cls_from_urn(
        getattr(common_urns.environments, portable.environment_type).urn
    )
    pipeline = beam.Pipeline(runner="FnApiRunner")
    _ = pipeline | beam.Create([1]) | beam.Map(str)
    told = pipeline.to_runner_api(default_environment=kind.from_options(portable))
    return next(iter(told.components.environments.values()))


@pytest.mark.parametrize(
    "document", documents(), ids=lambda one: one["metadata"]["name"]
)
def test_no_container_runs_as_root_or_without_limits(document: Any) -> None:
    spec = document["spec"].get("jobTemplate", document)["spec"]
    pod = spec.get("template", spec.get("taskManager", {}).get("podTemplate"))["spec"]
    for container in pod["containers"]:
        if "nostalgin" in container["name"]:
            assert container["resources"]["limits"]["memory"]
    if document["kind"] in ("Job", "CronJob"):
        assert pod["securityContext"]["runAsNonRoot"]
