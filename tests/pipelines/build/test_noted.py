import json
from pathlib import Path

from pipelines.build.noted import note
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
