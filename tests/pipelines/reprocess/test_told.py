"""What the command tells of what it found and did."""

import json
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


def test_a_plan_tells_how_many_corrections_are_rejected(city: Path) -> None:
    assert "corrections" not in run(city, "reprocess", "--dry-run").output
    lines = "building_id,what,value\n9-9,height_m,18\n9-8,height_m,18\n"
    (city / "corrections.csv").write_text(lines)
    done = run(city, "reprocess", "--dry-run")
    said = done.output
    assert done.exit_code == 0, repr(done.exception)
    assert "2 corrections rejected: `nostalgin corrections` tells why" in said
    told = json.loads(run(city, "reprocess", "--dry-run", "--json").stdout)
    assert told["corrections_rejected"] == 2


def test_what_is_gone_is_counted_with_what_is_asked_for(city: Path) -> None:
    path = city / "manifest.csv"
    lines = path.read_text().splitlines(keepends=True)
    path.write_text(
        "".join(one for one in lines if "5_" not in one and ",5," not in one)
    )
    said = run(city, "reprocess", "--dry-run", "--no-index").output
    assert "3 of 4 photographs to be redone (3 removed)" in said
    assert "1 of 2 blocks to be looked at again (1 by rows)" in said
