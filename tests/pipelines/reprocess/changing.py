"""Cities that change after they were built."""

import os
import shutil
from pathlib import Path

from pipelines import reprocess
from pipelines.index.index import index
from pipelines.models import Models
from pipelines.reprocess import Plan
from pipelines.store import Store
from tests.pipelines import painted
from tests.pipelines.cities import built

HERE = ("--stage_seconds=0",)
LONG_AGO = 1_000_000_000  # seconds


def aged(folder: Path) -> None:
    """Let photographs be old: what is as young as the run is read again."""
    for path in folder.iterdir():
        os.utime(path, (LONG_AGO, LONG_AGO))


def written(folder: Path) -> Path:
    """Build a city from a folder's photographs and a list, and keep a copy of all."""
    city = painted.write_city(folder / "work")
    aged(folder / "work/photos")
    built(city, HERE)
    shutil.copytree(folder / "work", folder / "kept")
    return city


def restored(city: Path) -> Path:
    """Let a city be again as it was written, in the place that its manifest names."""
    shutil.rmtree(city.parent)
    shutil.copytree(city.parent.with_name("kept"), city.parent)
    return city


def listed(city: Path) -> None:
    """Index the photographs and the list beside a city anew."""
    index(city.parent / "photos", city.parent / "list.csv", str(city))


def planned(city: Path, **asked: bool | int) -> Plan:
    models = Models(str(city.parent / "models"))
    return reprocess.planned(reprocess.now(Store(str(city)), models), **asked)


def add(city: Path, name: str, row: str, seed: int = 9) -> Path:
    """Add a photograph and its row of the list."""
    path = city.parent / "photos" / name
    path.write_bytes(painted.photo(seed, suffix=path.suffix))
    with (city.parent / "list.csv").open("a") as file:
        file.write(row + "\n")
    listed(city)
    return path


def remove(city: Path, name: str) -> None:
    """Remove a photograph and its row of the list."""
    (city.parent / "photos" / name).unlink()
    path = city.parent / "list.csv"
    lines = [one for one in path.read_text().splitlines() if not one.startswith(name)]
    path.write_text("\n".join(lines) + "\n")
    listed(city)


def change(city: Path, name: str, seed: int = 8) -> None:
    """Write another photograph under a name."""
    path = city.parent / "photos" / name
    path.write_bytes(painted.photo(seed, suffix=path.suffix))
