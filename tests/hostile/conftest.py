"""One city of hostile photographs, names and rows beside good ones, built once."""

import csv
import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from pipelines.cli import app
from pipelines.index import manifest
from pipelines.store import Store, runs
from tests.hostile import catalogues, images, manifests, names
from tests.hostile.case import bounded
from tests.pipelines import painted

GOOD = ("good/5_1.png", "good/5_2.png")
# Photographs all the same, of which a few are taken as far as they go; it takes time.
TAKEN = ("float_nan.tif", "exif_rubbish.jpg", "turned_6.jpg", "black.png", "ribbon.png")
MANIFEST = {"manifest.csv", "manifest.parquet", "indexed.json", "profile.toml"}
MADE = MANIFEST | {"readings.parquet", "readings", "warnings.parquet"}
BUILT = MADE | {"artifacts", "runs", "site", "CURRENT", "metrics.prom"}
Events = dict[str, list[dict[str, Any]]]  # rejections, by what each names


@dataclass(frozen=True)
class Told:
    """What came out of an index and a build of a whole folder of hostile files."""

    folder: Path
    codes: tuple[int, int]
    rejected: Events
    shown: frozenset[str]  # photographs of which facades were made
    blocks: frozenset[str]
    numbers: dict[str, int]  # of the hostile rows of the manifest


@dataclass(frozen=True)
class Listed:
    """What came out of an index with a list of hostile rows."""

    city: Path
    code: int
    rejected: Events
    blocks: frozenset[str]
    numbers: dict[str, int]


@pytest.fixture(scope="session")
def told(tmp_path_factory: pytest.TempPathFactory) -> Told:
    """Index a folder in which two photographs are good, mend the manifest, build."""
    folder = tmp_path_factory.mktemp("hostile")
    write_photos(folder / "photos")
    networks = {"segment": painted.segment_network()}
    networks["inpaint"] = painted.inpaint_network()
    models = painted.write_models(folder / "models", **networks)
    city = folder / "city"
    first, indexed = nostalgin("index", folder / "photos", "-o", city)
    numbers = mend(city / manifest.CSV)
    (folder / "photos" / "memory.jpg").symlink_to("/proc/self/mem")
    words = ("--models", models, "--max-rejected", 1)
    second, built = nostalgin("build", city, *words)
    store, run = Store(str(city)), (city / "CURRENT").read_text().strip()
    seen = runs.read_column(store, run, "facades", "name")
    blocks = runs.read_column(store, run, "blocks", "block")
    events = rejected([*indexed, *built])
    shown, raised = frozenset(seen), frozenset(blocks)
    return Told(folder, (first, second), events, shown, raised, numbers)


def mend(path: Path) -> dict[str, int]:
    """Write hostile rows below those of a manifest, by its first good photograph."""
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    good = next(row for row in rows if row["photo"] == GOOD[0])
    hostile = {}
    with path.open("a", newline="") as file:
        for number, case in enumerate(manifests.rows(), len(rows) + manifest.FIRST_ROW):
            cells = good | {"front_id": f"hostile-{number}", "block": str(number)}
            csv.writer(file).writerow((cells | case.cells).values())
            hostile[case.called] = number
    return hostile


@pytest.fixture(scope="session")
def listed(tmp_path_factory: pytest.TempPathFactory) -> Listed:
    """Index one good photograph with a list of hostile rows, each of its own block."""
    folder = tmp_path_factory.mktemp("listed")
    put(folder / "photos" / catalogues.GOOD, painted.photo())
    columns = "photo block lot street address width_m ring side order credit".split()  # noqa: SIM905
    numbers = {}
    with (folder / "list.csv").open("w", newline="") as file:
        csv.writer(file).writerows([columns, [catalogues.GOOD, "5", "1"]])
        for number, case in enumerate(catalogues.rows(), 3):
            cells = dict.fromkeys(columns, "") | {"block": case.called, "lot": "1"}
            csv.writer(file).writerow((cells | case.cells).values())
            numbers[case.called] = number
    city = folder / "city"
    words = ("--catalogue", folder / "list.csv", "-o", city)
    code, events = nostalgin("index", folder / "photos", *words)
    rows = manifest.read(Store(str(city))).rows
    blocks = frozenset(row.front.block for row in rows if row.front)
    return Listed(city, code, rejected(events), blocks, numbers)


def rejected(events: list[dict[str, Any]]) -> Events:
    found: Events = {}
    for event in events:
        if event["event"] == "rejected":
            found.setdefault(event["key"], []).append(event)
    return found


def write_photos(folder: Path) -> None:
    good = painted.photo()
    for name in GOOD:
        put(folder / name, painted.photo(int(name[-5])))
    for image in images.cases():
        if image.reason or image.name in TAKEN:
            put(folder / "images" / image.name, image.make())
    for name in names.cases():
        put(Path(os.fsdecode(os.fsencode(folder) + b"/" + name.file)), good)


def put(path: Path, data: bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)


def nostalgin(*words: object) -> tuple[int, list[dict[str, Any]]]:
    """Run a command, and read what it tells machines."""
    with bounded():
        result = CliRunner().invoke(app, [*map(str, words), "--json"])
    if result.exception and not isinstance(result.exception, SystemExit):
        raise result.exception
    lines = [line for line in result.output.splitlines() if line.startswith("{")]
    return result.exit_code, [json.loads(line) for line in lines]
