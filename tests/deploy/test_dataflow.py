"""The flex template: what it says is what a build takes, and its graph is built.

Nothing is sent to Google: the graph is built as the runner would send it.
"""

import importlib.util
import json
import re
from pathlib import Path
from typing import Any

import apache_beam as beam
import pytest
from apache_beam.options.pipeline_options import (
    GoogleCloudOptions,
    StandardOptions,
    WorkerOptions,
)
from apache_beam.transforms.environments import DockerEnvironment

from pipelines.build.bench import Bench
from pipelines.build.build import write
from pipelines.build.city import city as wired
from pipelines.build.options import CityOptions
from pipelines.index.asked import Asked
from pipelines.models import Models
from pipelines.store import Store
from pipelines.store.versions import Versions
from tests.data import ROOT

FOLDER = ROOT / "deploy" / "dataflow"
METADATA = json.loads((FOLDER / "metadata.json").read_text())
IMAGE = "registry.example/nostalgin-dataflow:0.1.0"
GIVEN = {
    "city": "gs://archive/city",
    "sdk_container_image": IMAGE,
    "shard": "3/16",
    "schemes": "gs,s3",
    "stage_seconds": "60",
    "stage_gigabytes": "2.5",
}
GOOGLE = ("--project=archive", "--region=europe-west1", "--temp_location=gs://a/t")


def launch() -> Any:
    spec = importlib.util.spec_from_file_location("launch", FOLDER / "launch.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def options(monkeypatch: pytest.MonkeyPatch) -> Any:
    """What the launcher makes of the template's parameters, and Dataflow's own."""
    monkeypatch.setattr("pipelines.build.cluster.equipped", lambda *_: None)
    words = [f"--{one['name']}={GIVEN[one['name']]}" for one in METADATA["parameters"]]
    return launch().asked([*words, *GOOGLE])


def test_each_parameter_of_the_template_arrives(options: Any) -> None:
    ours = options.view_as(CityOptions)
    assert (ours.city, ours.shard) == (GIVEN["city"], GIVEN["shard"])
    assert ours.allow_schemes == "gs,s3"
    assert (ours.stage_seconds, ours.stage_gigabytes) == (60.0, 2.5)
    assert options.view_as(StandardOptions).runner == "DataflowRunner"
    assert options.view_as(WorkerOptions).sdk_container_image == IMAGE
    google = options.view_as(GoogleCloudOptions)
    assert (google.project, google.region) == ("archive", "europe-west1")


def test_what_is_given_passes_the_template_s_own_check() -> None:
    assert {one["name"] for one in METADATA["parameters"]} == set(GIVEN)
    for one in METADATA["parameters"]:
        for regex in one.get("regexes", ()):
            assert re.fullmatch(regex, GIVEN[one["name"]])
    (city,) = [one for one in METADATA["parameters"] if one["name"] == "city"]
    assert not re.fullmatch(city["regexes"][0], "gs://user:secret@archive/city")


def test_the_graph_names_the_image_and_each_stage(options: Any, tmp_path: Path) -> None:
    pipeline = beam.Pipeline(runner="FnApiRunner")
    todo = Asked(run="0" * 12, rows=720_000, photos=720_000, blocks=20_000, groups=720)
    bench = Bench(Store(str(tmp_path)), Versions.present(Models()), Models())
    write(wired(pipeline, todo, bench), bench, todo.run, parts=36)
    image = options.view_as(WorkerOptions).sdk_container_image
    where = DockerEnvironment.from_container_image(image)  # as Dataflow's runner does
    assert where.container_image == IMAGE
    told = pipeline.to_runner_api(default_environment=where)
    names = {one.unique_name for one in told.components.transforms.values()}
    assert {"Segment", "Matte", "Rectify", "Inpaint", "Model"} <= names
    payloads = [one.payload for one in told.components.environments.values()]
    assert any(IMAGE.encode() in payload for payload in payloads)
