"""Real Airflow loads the DAG, and its task redoes what is stale in a real city."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.pipelines.reprocess import changing

HERE = Path(__file__).parents[2]
AIRFLOW = HERE / ".tools/airflow/bin"
PATIENCE_S = 900  # a database is made, and a process for the task; machines are busy
RUN = """
import json, os
from airflow.models.dagbag import DagBag
bag = DagBag(os.environ["AIRFLOW__CORE__DAGS_FOLDER"], include_examples=False)
assert not bag.import_errors, bag.import_errors
run = bag.dags["nostalgin"].test()
states = {one.task_id: str(one.state) for one in run.get_task_instances()}
print("\\n" + json.dumps({"run": str(run.state), "tasks": states}))
"""


def called(home: Path, city: Path, *command: str) -> str:
    """Call one of Airflow's programs with a database of its own."""
    environment = os.environ | {
        "AIRFLOW_HOME": str(home),
        "AIRFLOW__CORE__DAGS_FOLDER": str(HERE / "deploy/airflow"),
        "AIRFLOW__CORE__LOAD_EXAMPLES": "False",
        "NOSTALGIN_CITY": str(city),
        "NOSTALGIN_COMMAND": str(Path(sys.executable).with_name("nostalgin")),
        "NOSTALGIN_OPTIONS": f"--models {city.parent / 'models'} --stage_seconds=0",
    }
    done = subprocess.run(
        [AIRFLOW / command[0], *command[1:]],
        env=environment,
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-4000:] + done.stderr[-4000:]
    return done.stdout


@pytest.mark.skipif(
    not (AIRFLOW / "airflow").exists(), reason="no Airflow: call `make airflow`"
)
@pytest.mark.timeout(3 * PATIENCE_S)
def test_airflow_loads_the_dag_and_its_task_redoes_what_is_stale(
    tmp_path: Path,
) -> None:
    city = changing.written(tmp_path / "painted")
    shown = (city / "CURRENT").read_text()
    changing.change(city, "6_1.png")
    called(tmp_path / "airflow", city, "airflow", "db", "migrate")
    told = called(tmp_path / "airflow", city, "python", "-c", RUN).splitlines()[-1]
    assert json.loads(told) == {"run": "success", "tasks": {"reprocess": "success"}}
    assert (city / "CURRENT").read_text() != shown
    assert changing.planned(city).nothing
