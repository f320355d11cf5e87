"""A build's work as people have corrected it, and what that is a hash of."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any

from pipelines.build.streets import Streets
from pipelines.index import manifest
from pipelines.index.plan import BlockTask, PhotoRef
from pipelines.index.row import Refused, Row
from pipelines.index.source import Source, Unusable
from pipelines.store import Store


@dataclass(frozen=True)
class Corrected:
    """The manifest's rows as corrected, and what is told that no row tells."""

    rows: Iterable[Row | Refused] | None = None  # None: nothing is corrected
    sha256: str = ""  # of the corrections
    heights_m: dict[str, float] = field(default_factory=dict)  # by building
    targets_px: dict[str, float] = field(default_factory=dict)  # x, by photo
    outlines: dict[str, str] = field(default_factory=dict)  # of fronts, by photo
    quads: dict[str, str] = field(default_factory=dict)  # the same
    streets: Streets = field(default_factory=Streets)  # told with the city's places
    rejected: int = 0  # corrections that change nothing

    def drawn_on(self, name: str) -> tuple[str, str]:
        """Give what somebody drew on a photo: an outline and a quad."""
        return self.outlines.get(name, ""), self.quads.get(name, "")

    def drawn(self, ref: PhotoRef) -> PhotoRef:
        """Tell a photo what somebody drew on it."""
        outline, quad = self.drawn_on(ref.name)
        return replace(ref, outline=outline, quad=quad)

    def told(self) -> dict[str, dict[str, Any]]:
        """Give what no row tells, by what it is told of."""
        return {
            "heights_m": self.heights_m,
            "targets_px": self.targets_px,
            "outlines": self.outlines,
            "quads": self.quads,
            "widths_m": dict(self.streets.widths_m),
            "gaps_m": dict(self.streets.gaps_m),
        }

    def directions(self) -> "Corrected":
        """Leave out the rows, which workers read elsewhere."""
        return replace(self, rows=None)

    def directed(self, task: BlockTask) -> BlockTask:
        """Tell a block what no row tells: heights that are known, and facades meant."""
        task = self.streets.told(task)
        if not self.heights_m and not self.targets_px:
            return task
        lots = {f"{front.block}-{front.lot}" for front in task.fronts}
        heights_m = {one: h for one, h in self.heights_m.items() if one in lots}
        names = dict.fromkeys(name for name, _ in task.photos)
        targets_px = {
            name: self.targets_px[name[1]]
            for name in names
            if name[1] in self.targets_px
        }
        return replace(
            task,
            heights_m=tuple(sorted(heights_m.items())),
            targets_px=tuple(sorted(targets_px.items())),
        )


def in_place(row: Row) -> tuple[object, ...]:
    """Order rows as the manifest does, each block's together."""
    cells = manifest.row_of(row.photo, row.front, root=row.root, credit=row.credit)
    return (*manifest.place(cells), row.number)


def corrected(store: Store, there: Source) -> Corrected:
    """Merge a city's corrections over its manifest; the file itself stays as it is.

    Where there are any, all rows are held at once.

    Raises:
        Unusable: if a file of corrections can't be read at all: a city without them is
            not what is asked for.
    """
    from pipelines import corrections  # whose models of records no worker needs

    given = corrections.read(store)
    for why in given.unreadable:
        raise Unusable(f"{store.root}/{why.key} {why.detail}")
    if not given.sha256:
        return Corrected()
    cells = (one for batch in there.batches() for one in batch)
    results = list(manifest.checked(cells))
    rows = [one for one in results if isinstance(one, Row)]
    made = corrections.fitting(corrections.applied(rows, given), store)
    refused = [one for one in results if isinstance(one, Refused)]
    ordered = sorted(made.rows, key=in_place)
    every = (*refused, *map(Refused, made.rejections), *ordered)
    return Corrected(
        every,
        given.sha256,
        dict(made.heights_m),
        dict(made.targets_px),
        dict(made.outlines),
        dict(made.quads),
        rejected=len(made.rejections),
    )
