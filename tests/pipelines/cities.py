"""Cities that tests build, look at and spoil."""

import hashlib
import shutil
from collections.abc import Sequence
from pathlib import Path

from pipelines import build
from pipelines.build import Report

OF_BUILDS = ("CURRENT", "metrics.prom", ".lock")  # all else beside them is index's


def built(city: Path, beam: Sequence[str] = (), shard: str = "") -> Report:
    models = str(city.parent / "models")
    chosen = build.options(str(city), models=models, beam=beam, shard=shard)
    return build.build(chosen)


def tree(city: Path) -> dict[str, str]:
    """Hash every file of a city, but for the lock and those that tell the time."""
    return {
        path.relative_to(city).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(city.rglob("*"))
        if path.is_file()
        and path.suffix != ".prom"
        and path.name not in ("run.json", ".lock")
    }


def artifacts(city: Path, stage: str) -> list[Path]:
    return sorted((city / "artifacts" / stage).rglob("*.parquet"))


def copied(city: Path, folder: Path) -> Path:
    """Copy an unbuilt city with its networks; the photos stay where they are."""
    shutil.copytree(city.parent / "models", folder / "models")
    fresh = folder / "city"
    fresh.mkdir()
    for path in city.iterdir():
        if path.is_file() and path.name not in OF_BUILDS:
            shutil.copy(path, fresh / path.name)
    return fresh
