"""Corrections merged over the manifest's rows; each tells what it changed.

What a correction touches is what it is merged into: a photograph's key moves it to
other fronts, a width or an order changes a front and so its block, a height or a target
its block alone, a mask or a quad its photograph from that stage on. Stages' keys are
made of what they work on, so that nothing else is done again.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

from nostalgin_core.records import Rejection
from pipelines.corrections.corrections import Correction, Corrections
from pipelines.corrections.mending import Rows
from pipelines.index.row import Row

MOST_NAMES: Final = 8  # of a lot's fronts, in a message

# What is done again for each; what it is made from is found.
AGAIN: Final = {
    "key": "the blocks that the photo leaves and enters",
    "placard": "the blocks that the photo leaves and enters",
    "target": "its blocks",
    "mask": "the photo from matte on, its blocks",
    "quad": "the photo from rectify on, its blocks",
    "width_m": "its block",
    "order": "its block",
    "height_m": "its block",
}


@dataclass(frozen=True)
class Change:
    """What one correction changed."""

    row: str
    what: str
    subject: str
    before: str
    after: str
    note: str

    @property
    def again(self) -> str:
        """Tell what is done again for it."""
        return AGAIN[self.what] if self.before != self.after else "nothing"


@dataclass(frozen=True)
class Applied:
    """The rows as corrected, and what is told to the stages that no row tells."""

    rows: tuple[Row, ...]
    changes: tuple[Change, ...] = ()
    rejections: tuple[Rejection, ...] = ()
    heights_m: Mapping[str, float] = field(default_factory=dict)  # by building
    targets_px: Mapping[str, float] = field(default_factory=dict)  # x, by photo
    outlines: Mapping[str, str] = field(default_factory=dict)  # of fronts, by photo
    quads: Mapping[str, str] = field(default_factory=dict)  # the same


def applied(rows: Sequence[Row], corrections: Corrections) -> Applied:
    """Merge corrections over rows: keys first, then widths, then orders.

    One that speaks of what is not there is rejected by its row, and changes nothing.
    The work is linear in rows and in what corrections touch.
    """
    work = Work(corrections.rejections)
    for row in rows:
        work.rows.add(row)
    ways = {
        "key": keyed,
        "placard": keyed,
        "width_m": widened,
        "order": ordered,
        "height_m": heightened,
        "target": targeted,
        "mask": outlined,
        "quad": cornered,
    }
    for what, way in ways.items():
        for one in corrections.given:
            if one.what == what:
                way(work, one)
    return work.applied()


class Work:
    """What corrections are merged into, one after the other."""

    def __init__(self, rejections: Sequence[Rejection]) -> None:
        """Begin with no rows, and with the corrections that could not be read."""
        self.rows = Rows()
        self.changes: list[Change] = []
        self.rejections = list(rejections)
        self.heights_m: dict[str, float] = {}
        self.targets_px: dict[str, float] = {}
        self.outlines: dict[str, str] = {}
        self.quads: dict[str, str] = {}

    def changed(self, one: Correction, before: str, after: str) -> None:
        """Tell what a correction changed."""
        change = Change(one.row, one.what, one.subject, before, after, one.note)
        self.changes.append(change)

    def refused(self, one: Correction, reason: str, remedy: str) -> None:
        """Tell why a correction changed nothing."""
        detail = f"{one.what} of {one.subject[:80]}: {remedy}"
        self.rejections.append(Rejection(one.row, "corrections", reason, detail))

    def applied(self) -> Applied:
        """Give what came of all."""
        return Applied(
            tuple(self.rows),
            tuple(self.changes),
            tuple(self.rejections),
            self.heights_m,
            self.targets_px,
            self.outlines,
            self.quads,
        )


def keyed(work: Work, one: Correction) -> None:
    """Let a photograph show the fronts of another lot."""
    block, lot = one.lot_key
    fronts = {
        front.front_id: front
        for front in reversed(work.rows.fronts_of_building(f"{block}-{lot}"))
        if (front.block, front.lot) == (block, lot)
    }
    own = work.rows.of_photo(one.photo)
    if not own:
        work.refused(one, "no such photo", "write it as the manifest does")
        return
    if not fronts:
        why = f"add a front of block {block}, lot {lot} to the list, or mend the key"
        work.refused(one, "no such lot", why)
        return
    before = {f"{r.front.block}-{r.front.lot}" for r in own if r.front}
    work.rows.drop_photo(one.photo)
    left = [
        replace(row, photo="", cells=dict(row.cells))
        for row in own
        if row.front
        and row.front.front_id not in fronts
        and not work.rows.has_front(row.front)
    ]
    work.rows.drop_bare(fronts)
    shown = [replace(own[0], front=front) for front in reversed(fronts.values())]
    for row in (*left, *shown):
        work.rows.add(row)
    work.changed(one, ", ".join(sorted(before)), f"{block}-{lot}")


def widened(work: Work, one: Correction) -> None:
    """Let a front be as wide as is known."""
    first = work.rows.front(one.front_id)
    if first is None:
        work.refused(one, "no such front", of_its_lot(work.rows, one.front_id))
        return
    mark = " assumed" if first.width_assumed else ""
    work.rows.mend(one.front_id, width_m=one.number, width_assumed=False)
    work.changed(one, f"{first.width_m:g}{mark}", f"{one.number:g}")


def ordered(work: Work, one: Correction) -> None:
    """Let a front stand elsewhere in its ring: 12.5 is between ranks 12 and 13.

    It takes the side of its new neighbours, where both have the same.
    """
    moved = work.rows.front(one.front_id)
    if moved is None:
        work.refused(one, "no such front", of_its_lot(work.rows, one.front_id))
        return
    others = {
        front.front_id: front
        for front in reversed(work.rows.fronts_of_ring(moved.block, moved.ring))
        if front.front_id != moved.front_id
    }
    places = sorted(others.values(), key=lambda front: (front.rank, front.front_id))
    before = [front for front in places if front.rank < one.number]
    after = places[len(before) :]
    sides = {front.side for front in (*before[-1:], *after[:1])}
    side = sides.pop() if len(sides) == 1 else moved.side
    for rank, front in enumerate((*before, moved, *after)):
        if front is moved:
            work.rows.mend(front.front_id, rank=rank, side=side)
        elif front.rank != rank:
            work.rows.mend(front.front_id, rank=rank)
    work.changed(one, f"{moved.rank}", f"{len(before)}")


def heightened(work: Work, one: Correction) -> None:
    """Let a building be as high as is known."""
    if not work.rows.fronts_of_building(one.building_id):
        work.refused(one, "no such building", "write it as block-lot")
        return
    work.heights_m[one.building_id] = one.number
    work.changed(one, "as photographed", f"{one.number:g}")


def targeted(work: Work, one: Correction) -> None:
    """Let the facade at a place of a photograph be the one it is a record of."""
    if there(work, one):
        work.targets_px[one.photo] = one.number
        work.changed(one, "as segmented", f"x = {one.number:g} px")


def outlined(work: Work, one: Correction) -> None:
    """Let a photograph's front be what is drawn round it."""
    if there(work, one):
        work.outlines[one.photo] = one.shape
        work.changed(one, "as segmented", one.shape)


def cornered(work: Work, one: Correction) -> None:
    """Let a photograph's front have the corners that are drawn."""
    if there(work, one):
        work.quads[one.photo] = one.shape
        work.changed(one, "as rectified", one.shape)


def there(work: Work, one: Correction) -> bool:
    """Tell whether there is the photograph of which a correction speaks."""
    found = bool(work.rows.of_photo(one.photo))
    if not found:
        work.refused(one, "no such photo", "write it as the manifest does")
    return found


def of_its_lot(rows: Rows, front_id: str) -> str:
    """Say which names the fronts of a lot have in the manifest.

    A model also names walls that were made round a corner: they are of no row.
    """
    names = rows.names_beside(front_id)
    if not names:
        return "no lot has it: write a front_id of manifest.csv, as block-lot-side"
    shown = ", ".join(names[:MOST_NAMES])
    return f"its lot has {shown} in manifest.csv: write one of these"
