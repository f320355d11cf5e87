"""What no kept run refers to is dropped: artifacts, and runs that nobody asked to keep.

A run refers to the artifacts of every photo that it read, at the versions it ran with,
to the elevations that its buildings wear, to what neighbours lent them, to what came of
comparing its blocks' facades, and to its models.
"""

import contextlib
import json
from collections import defaultdict
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Any, Final

from pipelines.store import runs
from pipelines.store.packing import artifact, repack
from pipelines.store.seal import Damaged
from pipelines.store.shelf import ARTIFACT, Shelf
from pipelines.store.store import ARTIFACTS, Store
from pipelines.store.versions import Versions

DRAWN: Final = ("outline", "quad")  # columns of a run's photos
# A stage whose artifacts these are, if runs of older cities had none; table; column.
NAMED: Final = (
    ("", "buildings", "elevations"),
    ("", "blocks", "model"),
    ("borrow", "borrowed", "borrowed"),
    ("compare", "blocks", "compared"),
)


class Unknown(ValueError):  # noqa: N818 - it reads as what it is about
    """A run that is to be kept, but does not tell what it refers to."""


@dataclass(frozen=True)
class Dropped:
    """What was dropped, or would be."""

    kept_runs: tuple[str, ...]
    runs: tuple[str, ...]
    artifacts: int
    packs: int  # that were written anew, or dropped whole


def drop_unkept(store: Store, *, keep: int = 1, dry: bool = False) -> Dropped:
    """Drop what neither the published run nor the last `keep` runs refer to.

    Raises:
        Unknown: if one of these does not tell what it refers to.
    """
    kept, others = chosen(store, keep)
    wanted: dict[str, set[str]] = defaultdict(set)
    for run in kept:
        for folder, key in referred(store, run):
            wanted[folder].add(key)
    artifacts = packs = 0
    for folder in folders(store):
        there = store.listed(folder)
        spare = set(there) - wanted[folder]
        artifacts += len(spare)
        touched = packs_of(there, spare)
        packs += len(touched)
        if dry:
            continue
        for key in sorted(spare & there.loose):
            store.remove(artifact(folder, key))
        for pack in touched:
            repack(store, folder, pack, without=spare)
    for run in () if dry else others:
        drop_run(store, run)
    return Dropped(kept, others, artifacts, packs)


def drop_run(store: Store, run: str) -> None:
    """Drop a run's folder, and in it that of a part which was at work."""
    store.drop_tree(f"runs/{run}")
    store.drop_folder("runs")


def chosen(store: Store, keep: int) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Part the runs into those to keep and the others: the published one is kept."""
    current = ""
    with contextlib.suppress(FileNotFoundError):
        current = runs.shown(store)
    there = sorted(store.names("runs"), key=lambda run: began(store, run), reverse=True)
    kept = [run for n, run in enumerate(there) if n < keep or run == current]
    return tuple(kept), tuple(run for run in there if run not in kept)


def began(store: Store, run: str) -> str:
    """Tell when a run began, so that later ones sort behind."""
    return str(record(store, run).get("began", ""))


def record(store: Store, run: str) -> dict[str, Any]:
    """Read what a run tells of itself."""
    try:
        told = json.loads(store.read_bytes(f"runs/{run}/run.json"))
    except (OSError, ValueError):
        return {}
    return told if isinstance(told, dict) else {}


def referred(store: Store, run: str) -> Iterator[tuple[str, str]]:
    """List what a run refers to: a stage's folder, and a key.

    Raises:
        Unknown: if it does not tell.
    """
    try:
        versions = Versions(**record(store, run)["versions"])
        for one in photos(store, run):
            yield from of_photo(versions, **one)
        for stage, name, column in NAMED:
            told = not stage or getattr(versions, stage)
            for (cell,) in cells(store, run, name, column) if told else ():
                for path in [cell] if isinstance(cell, str) else cell:
                    found = ARTIFACT.fullmatch(path)
                    if found:
                        yield found[1], found[2]
    except (KeyError, TypeError, FileNotFoundError, Damaged) as problem:
        raise Unknown(
            f"{store.root}: run {run} does not tell what it refers to ({problem!r}): "
            "build once more, or keep fewer runs"
        ) from problem


def photos(store: Store, run: str) -> Iterator[dict[str, str]]:
    """Read what a run's photos were made of; earlier runs knew of no drawing."""
    for table in runs.each_part(store, run, "photos", ["sha256", *DRAWN]):
        for row in table.to_pylist():
            drawn = {name: row.get(name) or "" for name in DRAWN}
            yield {"sha256": row["sha256"]} | drawn


def of_photo(
    versions: Versions, *, sha256: str, outline: str, quad: str
) -> Iterator[tuple[str, str]]:
    """List the artifacts of one photo."""
    yield versions.folder("segment"), versions.segment_key(sha256)
    yield versions.folder("placard"), versions.placard_key(sha256)
    yield versions.folder("thumbnail"), versions.thumbnail_key(sha256)
    yield versions.folder("matte"), versions.matte_key(sha256, outline)
    yield versions.folder("rectify"), versions.rectify_key(sha256, outline, quad)


def cells(store: Store, run: str, name: str, column: str) -> Iterator[tuple[Any]]:
    """Read a column of a run's table, part by part."""
    for table in runs.each_part(store, run, name, [column]):
        yield from zip(table.column(column).to_pylist(), strict=True)


def folders(store: Store) -> Iterator[str]:
    """Name the folders of all versions of all stages."""
    for stage in store.names(ARTIFACTS):
        if stage != "aside":
            for version in store.names(f"{ARTIFACTS}/{stage}"):
                yield f"{ARTIFACTS}/{stage}/{version}"


def packs_of(there: Shelf, keys: Collection[str]) -> list[str]:
    """Name the packs that hold some of these artifacts, and those that are damaged."""
    found = (there.find(key) for key in keys)
    return sorted({one.pack for one in found if one is not None} | set(there.broken))
