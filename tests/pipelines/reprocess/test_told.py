"""What the command tells of what it found and did."""

import shutil
from pathlib import Path

import pytest

from tests.pipelines.cities import tree
from tests.pipelines.reprocess.test_grown import run


def shown(city: Path) -> dict[str, str]:
    return {name: h for name, h in tree(city).items() if "artifacts" not in name}


@pytest.mark.parametrize("told", [(), ("--json",)])
def test_what_was_made_again_is_summed_up(city: Path, told: tuple[str, ...]) -> None:
    (city.parent / "photos/6_1.png").write_bytes(b"no picture")
    assert run(city, "reprocess").exit_code == 0
    before = shown(city)
    shutil.rmtree(city / "artifacts/segment")
    done = run(city, "reprocess", *told)
    assert done.exit_code == 0, done.output
    assert "artifacts alone were made" in done.output or told
    assert shown(city) == before
