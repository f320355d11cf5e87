"""What came of a run: nothing was lost, and so much was made.

Of a million photos no process holds all names: a table is read part by part, and what
is remembered of a name is eight bytes.
"""

import json
from array import array
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Any, Final, NamedTuple

import numpy as np

from pipelines.index import asked
from pipelines.index.asked import Asked, short
from pipelines.index.row import Row
from pipelines.store import Store, runs
from pipelines.store.versions import Versions

MADE: Final = (  # which column of which table names the artifacts of which stage
    ("facades", "elevations", "rectify"),
    ("borrowed", "borrowed", "borrow"),
    ("buildings", "elevations", "inpaint"),
    ("blocks", "compared", "compare"),
    ("blocks", "model", "block"),
)


class Lost(RuntimeError):  # noqa: N818 - it reads as what it is about
    """Work that a runner neither did nor rejected, or that could not be kept."""


@dataclass(frozen=True)
class Rejections:
    """The rejections of a run, read from its table whenever they are asked for."""

    store: Store
    run: str

    def __iter__(self) -> Iterator[dict[str, Any]]:
        """Read one after another."""
        return runs.read_rows(self.store, self.run, "rejections")


@dataclass(frozen=True)
class Report:
    """What came of a build."""

    run: str
    photos: int
    rejected_photos: int
    facades: int
    blocks: int
    buildings: int
    assumed: int
    rejections: Iterable[dict[str, Any]]
    counted: tuple[tuple[str, int], ...] = ()  # rejections by stage and reason
    healed: int = 0  # artifacts that were damaged and made again
    held: bool = False  # a better site was not replaced
    fronts: int = 0
    widths_assumed: int = 0  # of the fronts: no list gave them
    heights_assumed: int = 0  # of the buildings: nothing supports them
    cpu_seconds: float = 0.0  # that the stages spent
    tabled: bool = True  # in the run's folder; else artifacts alone were made

    @property
    def rejected_share(self) -> float:
        """Tell which share of the photos gave nothing at all."""
        return self.rejected_photos / max(self.photos, 1)

    @property
    def shown_share(self) -> float:
        """Tell which share of the photos the city shows."""
        return (self.photos - self.rejected_photos) / max(self.photos, 1)

    def grave(self) -> Iterator[dict[str, Any]]:
        """Read the rejections that are of more than one facade among others."""
        return (one for one in self.rejections if one["facade"] is None)

    def reasons(self) -> list[tuple[str, int]]:
        """Count rejections by stage and reason, most first."""
        return sorted(self.counted, key=lambda one: (-one[1], one[0]))


class Wanted(NamedTuple):
    """What a run was asked for, each name as eight bytes, in the order of its rows."""

    photos: np.ndarray  # where a photo lies, and its name; of a row without: zero
    names: np.ndarray  # its name alone
    blocks: np.ndarray
    fronts: int  # that are different
    guessed: int  # of these, whose widths nobody gave


def wanted(store: Store, run: str) -> Wanted:
    """Read what a run was asked for."""
    photos, names, blocks = array("Q"), array("Q"), array("Q")
    known, guessed = array("Q"), array("Q")
    for row in asked.rows(store, run):
        if isinstance(row, Row):
            photos.append(short(row.root, row.photo) if row.photo else 0)
            names.append(short(row.photo))
            blocks.append(short(asked.block_of(row)))
            if row.front is not None:
                known.append(short(row.front.block, row.front.front_id))
                if row.front.width_assumed:
                    guessed.append(known[-1])
    fronts, unsure = (len(np.unique(one)) for one in (known, guessed))
    p, n, b = (np.frombuffer(one, np.uint64) for one in (photos, names, blocks))
    return Wanted(p, n, b, fronts, unsure)


def told(store: Store, run: str, name: str, column: str) -> np.ndarray:
    """Read the texts of a table's column, each as eight bytes."""
    found = array("Q")
    for table in runs.each_part(store, run, name, [column]):
        found.extend(map(short, table.column(column).to_pylist()))
    return np.frombuffer(found, np.uint64)


def check(store: Store, run: str, versions: Versions) -> None:
    """Insist that each photo and each block was made or rejected, and is kept.

    What is kept is known from a listing of the store, a stage at a time.

    Raises:
        Lost: if one was neither, or is not there.
    """
    want, rejected = wanted(store, run), told(store, run, "rejections", "key")
    photos = np.union1d(rejected, told(store, run, "facades", "name"))
    blocks = np.union1d(rejected, told(store, run, "blocks", "block"))
    lost = (want.photos != 0) & ~np.isin(want.names, photos)
    lost |= ~np.isin(want.blocks, blocks)
    if lost.any():
        usable = (row for row in asked.rows(store, run) if isinstance(row, Row))
        first = next(islice(usable, int(lost.argmax()), None))
        raise Lost(
            f"the runner lost {lost.sum()} rows' photos or blocks, "
            f"{first.photo or asked.block_of(first)} first: "
            "build again; what was done is kept"
        )
    for name, column, stage in MADE:
        kept = store.listed(versions.folder(stage))
        for path in paths(store, run, name, column):
            if not kept.has(path.rpartition("/")[2].removesuffix(".parquet")):
                raise Lost(f"{store.root} lost {path}: build again; it is made anew")


def paths(store: Store, run: str, name: str, column: str) -> Iterator[str]:
    """Read the artifacts that a table names."""
    for table in runs.each_part(store, run, name, [column]):
        for cell in table.column(column).to_pylist():
            yield from [cell] if isinstance(cell, str) else cell


def reported(store: Store, run: str, todo: Asked) -> Report:
    """Sum up a run from its tables."""
    want, seen = wanted(store, run), told(store, run, "facades", "name")
    _, first = np.unique(want.photos, return_index=True)
    once = first[want.photos[first] != 0]
    reasons: Counter[str] = Counter()
    for one in columns(store, run, "rejections", ("stage", "reason")):
        reasons[": ".join(one)] += 1
    counts = list(columns(store, run, "blocks", ("buildings", "assumed")))
    unsupported = columns(store, run, "buildings", ("height_supported",))
    return Report(
        run=run,
        photos=todo.photos + todo.unplaced,
        rejected_photos=int((~np.isin(want.names[once], seen)).sum()) + todo.unplaced,
        facades=len(seen),
        blocks=len(counts),
        buildings=sum(buildings for buildings, _ in counts),
        assumed=sum(assumed for _, assumed in counts),
        rejections=Rejections(store, run),
        counted=tuple(reasons.items()),
        fronts=want.fronts,
        widths_assumed=want.guessed,
        heights_assumed=sum(not supported for (supported,) in unsupported),
    )


def columns(
    store: Store, run: str, name: str, wanted: Iterable[str]
) -> Iterator[tuple[Any, ...]]:
    """Read some columns of a table, row by row."""
    names = list(wanted)
    for table in runs.each_part(store, run, name, names):
        yield from zip(*(table.column(one).to_pylist() for one in names), strict=True)


def remember(store: Store, report: Report) -> None:
    """Write beside a run's tables how much of it was published."""
    told = {"photos": report.photos, "shown_share": report.shown_share}
    store.write_bytes(f"runs/{report.run}/{runs.PUBLISHED}", json.dumps(told).encode())


def shown_before(store: Store) -> float:
    """Read which share of its photos the published city shows; none: there is none."""
    try:
        return float(of_shown(store, runs.PUBLISHED)["shown_share"])
    except (ValueError, KeyError, TypeError):
        return 0.0


def last_shown(store: Store) -> dict[str, Any]:
    """Read when the run was whose city is shown; nothing if there is none."""
    return of_shown(store, "run.json")


def of_shown(store: Store, name: str) -> dict[str, Any]:
    """Read a record of the published run."""
    try:
        run = runs.shown(store)
        told = json.loads(store.read_bytes(f"runs/{run}/{name}"))
    except (OSError, ValueError):
        return {}
    return told if isinstance(told, dict) else {}
