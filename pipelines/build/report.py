"""What came of a run: nothing was lost, and so much was made."""

import json
from collections import Counter
from dataclasses import dataclass
from typing import Any, Final

from pipelines import site
from pipelines.index.plan import Plan
from pipelines.store import Store, runs

PUBLISHED: Final = "published.json"


class Lost(RuntimeError):  # noqa: N818 - it reads as what it is about
    """Work that a runner neither did nor rejected, or that could not be kept."""


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
    rejections: tuple[dict[str, Any], ...]
    healed: int = 0  # artifacts that were damaged and made again
    held: bool = False  # a better site was not replaced
    fronts: int = 0
    widths_assumed: int = 0  # of the fronts: no list gave them
    heights_assumed: int = 0  # of the buildings: nothing supports them

    @property
    def rejected_share(self) -> float:
        """Tell which share of the photos gave nothing at all."""
        return self.rejected_photos / max(self.photos, 1)

    @property
    def shown_share(self) -> float:
        """Tell which share of the photos the city shows."""
        return (self.photos - self.rejected_photos) / max(self.photos, 1)

    def grave(self) -> list[dict[str, Any]]:
        """List the rejections that are of more than one facade among others."""
        return [one for one in self.rejections if one["facade"] is None]

    def reasons(self) -> list[tuple[str, int]]:
        """Count rejections by stage and reason, most first."""
        counted = Counter(f"{r['stage']}: {r['reason']}" for r in self.rejections)
        return sorted(counted.items(), key=lambda one: (-one[1], one[0]))


def check(store: Store, run: str, todo: Plan) -> None:
    """Insist that each photo and each block was made or rejected.

    Raises:
        Lost: if one was neither.
    """
    told = set(runs.read_column(store, run, "rejections", "key"))
    photos = told.union(runs.read_column(store, run, "facades", "name"))
    blocks = told.union(runs.read_column(store, run, "blocks", "block"))
    lost = [ref.name for ref in todo.photos if ref.name not in photos]
    lost += [task.block for task in todo.blocks if task.block not in blocks]
    if lost:
        raise Lost(
            f"the runner lost {len(lost)} photos or blocks, {lost[0]} first: "
            "build again; what was done is kept"
        )


def reported(store: Store, run: str, todo: Plan) -> Report:
    """Sum up a run from its tables."""
    facades = runs.read_column(store, run, "facades", "name")
    seen = set(facades)
    buildings = runs.read_column(store, run, "blocks", "buildings")
    fronts = [front for task in todo.blocks for front in task.fronts]
    supported = runs.read_column(store, run, "buildings", "height_supported")
    return Report(
        run=run,
        photos=len(todo.photos),
        rejected_photos=sum(ref.name not in seen for ref in todo.photos),
        facades=len(facades),
        blocks=len(buildings),
        buildings=sum(buildings),
        assumed=sum(runs.read_column(store, run, "blocks", "assumed")),
        rejections=tuple(runs.read_table(store, run, "rejections")),
        fronts=len(fronts),
        widths_assumed=sum(front.width_assumed for front in fronts),
        heights_assumed=sum(not one for one in supported),
    )


def remember(store: Store, report: Report) -> None:
    """Write beside a run's tables how much of it was published."""
    told = {"photos": report.photos, "shown_share": report.shown_share}
    store.write_bytes(f"runs/{report.run}/{PUBLISHED}", json.dumps(told).encode())


def shown_before(store: Store) -> float:
    """Read which share of its photos the published city shows; none: there is none."""
    try:
        run = store.read_bytes(site.CURRENT).decode().strip()
        told = json.loads(store.read_bytes(f"runs/{run}/{PUBLISHED}"))
        return float(told["shown_share"])
    except (OSError, ValueError, KeyError, TypeError):
        return 0.0
