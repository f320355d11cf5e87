"""A worker of another build, or with other networks, makes nothing."""

from dataclasses import replace
from pathlib import Path

import pytest

from pipelines.build import kin
from pipelines.build.bench import Bench
from pipelines.models import LOCK, PACKAGED, Models
from pipelines.store import Store
from pipelines.store.versions import CODE, Versions

OWN = Versions.present(Models())


def bench(folder: Path, versions: Versions, models: Models | None = None) -> Bench:
    return Bench(Store(str(folder)), versions, models or Models())


def test_who_is_of_the_same_build_passes_elements_on(tmp_path: Path) -> None:
    assert kin.akin("a", bench(tmp_path, OWN)) == "a"


@pytest.mark.parametrize("stage", CODE)
def test_another_version_of_any_stage_ends_the_run(tmp_path: Path, stage: str) -> None:
    other = bench(tmp_path, replace(OWN, **{stage: "0-of-another"}))
    with pytest.raises(kin.Strange, match=rf"would do {stage} otherwise: install"):
        kin.akin("a", other)


def test_other_networks_end_the_run(tmp_path: Path) -> None:
    names = '{"segment.onnx": "1", "inpaint.onnx": "2"}'
    (tmp_path / LOCK).write_text(names)
    own = bench(tmp_path, OWN, Models(str(tmp_path)))
    with pytest.raises(kin.Strange, match="do segment, inpaint otherwise"):
        kin.akin("a", own)


def test_the_package_s_networks_are_sought_where_the_process_has_it() -> None:
    assert Models().folder == ""
    assert Models().path == PACKAGED
