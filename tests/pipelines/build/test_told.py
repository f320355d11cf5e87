"""What a build tells machines: JSON by its schema, and no secret anywhere."""

import json
import os
import subprocess
import sys
from pathlib import Path

import jsonschema
import pytest

from pipelines.index import manifest
from pipelines.store import Store
from tests.data import ROOT
from tests.pipelines import painted

SCHEMA = json.loads((ROOT / "pipelines/console/events.schema.json").read_text())
PLANTED = "planted0secret0of0this0test"
CREDENTIALS = {
    "AWS_ACCESS_KEY_ID": PLANTED,
    "AWS_SECRET_ACCESS_KEY": PLANTED,
    "AWS_SESSION_TOKEN": PLANTED,
    "GOOGLE_APPLICATION_CREDENTIALS": f"/nowhere/{PLANTED}.json",
}
OPTIONS = [
    f"--s3_secret_access_key={PLANTED}",
    f"--s3_session_token={PLANTED}",
    f'--environment_config={{"env": {{"AWS_SECRET_ACCESS_KEY": "{PLANTED}"}}}}',
    f"--flink_master=https://us:{PLANTED}@nowhere:8081",
]


@pytest.fixture(scope="module")
def told(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str, str]:
    """A city of four photos and one that is missing, and what building it told."""
    city = painted.write_city(tmp_path_factory.mktemp("told"))
    rows = manifest.read(Store(str(city))).rows
    front = next(row for row in rows if row.photo)
    cells = [
        manifest.row_of(row.photo, row.front, root=row.root, credit="")
        for row in (*rows, front)
        if row.front
    ]
    cells[-1] = cells[-1] | {"photo": "missing.png"}
    manifest.write(Store(str(city)), cells)
    models = ["--models", str(city.parent / "models")]
    words = ["build", str(city), "--json", *models, *OPTIONS]
    done = subprocess.run(
        [sys.executable, "-m", "pipelines.cli", *words],
        cwd=ROOT,
        env=os.environ | CREDENTIALS,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return city, done.stdout, done.stderr


def test_each_line_is_an_event_by_the_schema(told: tuple[Path, str, str]) -> None:
    events = [json.loads(line) for line in told[1].splitlines()]
    for one in events:
        jsonschema.validate(one, SCHEMA)
    kinds = {one["event"] for one in events}
    assert kinds >= {"start", "rejected", "done"}
    (why,) = [one["key"] for one in events if one["event"] == "rejected"]
    assert why == "missing.png"


def test_the_schema_can_fail() -> None:
    for wrong in (
        {"event": "start", "run": "0123456789ab", "photos": -1, "blocks": 1},
        {"event": "warning", "warning": "w", "secret": PLANTED},
        {"event": "unheard"},
    ):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(wrong, SCHEMA)


def test_a_planted_secret_stands_in_no_file_and_no_line(
    told: tuple[Path, str, str],
) -> None:
    city, *streams = told
    assert not [text for text in streams if PLANTED in text]
    files = [path for path in city.rglob("*") if path.is_file()]
    names = {path.name for path in files}
    assert {"run.json", "metrics.prom", "photos.parquet"} <= names
    assert not [path for path in files if PLANTED.encode() in path.read_bytes()]
    (record,) = city.glob("runs/*/run.json")
    options = json.loads(record.read_text())["options"]
    assert options["city"] == str(city)  # while what is none is told
    assert options["environment_config"] == options["flink_master"] == "(not told)"
