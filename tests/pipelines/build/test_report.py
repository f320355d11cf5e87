"""A run ends well only if all that its tables name is in the store."""

import json
import shutil
from pathlib import Path

import pytest

from pipelines.build import report
from pipelines.build.report import Lost
from pipelines.store import Store
from pipelines.store.versions import Versions
from tests.pipelines.cities import artifacts


@pytest.mark.parametrize("stage", ["rectify", "compare", "inpaint", "block"])
def test_an_artifact_that_is_gone_is_missed_whatever_its_stage(
    city: Path, tmp_path: Path, stage: str
) -> None:
    other = tmp_path / "city"
    shutil.copytree(city, other)
    run = (other / "CURRENT").read_text().strip()
    told = json.loads((other / "runs" / run / "run.json").read_text())
    store, versions = Store(str(other)), Versions(**told["versions"])
    report.check(store, run, versions)
    found = artifacts(other, stage)
    for one in found:
        one.unlink()
    with pytest.raises(Lost, match=f"artifacts/{stage}/"):
        report.check(store, run, versions)
