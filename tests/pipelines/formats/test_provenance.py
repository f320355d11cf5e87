"""A built city tells what it came from, and another's program reads it."""

import hashlib
import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from pipelines.cli import app
from pipelines.formats import Unexportable, export
from tests.pipelines.formats.readers import told
from tests.pipelines.told import told_buildings

PROV = """
import json, sys
import prov.model
made = prov.model.ProvDocument.deserialize(sys.argv[1], format="json")
records = made.get_records()
count = lambda kind: sum(isinstance(one, kind) for one in records)
print(json.dumps({"entities": count(prov.model.ProvEntity),
    "derivations": count(prov.model.ProvDerivation),
    "activities": sorted(str(one.identifier) for one in records
        if isinstance(one, prov.model.ProvActivity))}))
"""


@pytest.fixture(scope="module")
def document(city: Path) -> dict[str, Any]:
    export(city, city.parent / "out", ("prov", "cityjson"))
    return json.loads((city.parent / "out/prov/provenance.json").read_text())


def test_every_input_is_named_with_its_hash(
    city: Path, document: dict[str, Any]
) -> None:
    hashes = {one.get("nostalgin:sha256") for one in document["entity"].values()}
    files = [*(city.parent / "photos").iterdir(), *(city / "site/blocks").iterdir()]
    files += [city / "manifest.csv", *(city.parent / "models").glob("*.onnx")]
    for file in files:
        assert hashlib.sha256(file.read_bytes()).hexdigest() in hashes, file


def test_every_stage_tells_its_version_and_its_parameters(
    document: dict[str, Any],
) -> None:
    for stage in ("segment", "matte", "rectify", "inpaint", "block"):
        one = document["activity"][f"stage:{stage}"]
        assert one["nostalgin:version"]
        assert json.loads(one["nostalgin:parameters"])
        off = {"nyc-records"} if stage == "rectify" else set()
        assert {*filter(None, [one.get("nostalgin:watermark")])} == off


def test_a_building_is_derived_from_the_photographs_that_it_wears(
    city: Path, document: dict[str, Any]
) -> None:
    worn = {
        (f"building:{building['id']}", f"photo:{photo['key']}")
        for building in told_buildings(city / "site")
        for photo in building["photos"]
        if photo["used"]
    }
    said = {
        (one["prov:generatedEntity"], one["prov:usedEntity"])
        for one in document["wasDerivedFrom"].values()
    }
    assert worn
    assert said == worn


def test_a_program_that_we_did_not_write_reads_it(
    city: Path, document: dict[str, Any]
) -> None:
    read = told("prov", PROV, str(city.parent / "out/prov/provenance.json"))
    assert read["entities"] == len(document["entity"])
    assert read["derivations"] == len(document["wasDerivedFrom"])
    assert set(read["activities"]) == set(document["activity"])


def test_a_site_of_another_run_is_refused(city: Path, tmp_path: Path) -> None:
    (glb, *_) = sorted((city / "site/blocks").iterdir())
    data = glb.read_bytes()
    glb.write_bytes(data + b"\0")
    try:
        with pytest.raises(Unexportable, match="build again"):
            export(city, tmp_path / "out", ("prov",))
    finally:
        glb.write_bytes(data)


def test_the_command_line_exports(city: Path, tmp_path: Path) -> None:

    words = ["export", str(city), "--to", "obj,prov", "-o", str(tmp_path / "out")]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0, done.output
    assert (tmp_path / "out/prov/provenance.json").is_file()
    assert CliRunner().invoke(app, ["export", str(tmp_path)]).exit_code == 1
