"""Corrections merged over the manifest's rows; each tells what it changed.

What a correction touches is what it is merged into: a photograph's key moves it to
other fronts, a width or an order changes a front and so its block, a height or a target
its block alone, a mask or a quad its photograph from that stage on. Stages' keys are
made of what they work on, so that nothing else is done again.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

from nostalgin_core.records import Front, Rejection
from pipelines.corrections.corrections import Correction, Corrections
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
    """
    made = Applied(tuple(rows), (), corrections.rejections)
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
                made = way(made, one)
    return made


def keyed(made: Applied, one: Correction) -> Applied:
    """Let a photograph show the fronts of another lot."""
    block, lot = one.lot_key
    fronts = {
        row.front.front_id: row.front
        for row in reversed(made.rows)
        if row.front and (row.front.block, row.front.lot) == (block, lot)
    }
    own = [row for row in made.rows if row.photo == one.photo]
    if not own:
        return refused(made, one, "no such photo", "write it as the manifest does")
    if not fronts:
        why = f"add a front of block {block}, lot {lot} to the list, or mend the key"
        return refused(made, one, "no such lot", why)
    before = {f"{r.front.block}-{r.front.lot}" for r in own if r.front}
    kept = [row for row in made.rows if row.photo != one.photo]
    there = {(row.front.block, row.front.front_id) for row in kept if row.front}
    left = [
        replace(row, photo="", cells=dict(row.cells))
        for row in own
        if row.front
        and (row.front.block, row.front.front_id) not in there
        and row.front.front_id not in fronts
    ]
    shown = [replace(own[0], front=front) for front in reversed(fronts.values())]
    bare = [r for r in kept if r.photo or not r.front or r.front.front_id not in fronts]
    rows = (*bare, *left, *shown)
    return changed(
        replace(made, rows=rows), one, ", ".join(sorted(before)), f"{block}-{lot}"
    )


def widened(made: Applied, one: Correction) -> Applied:
    """Let a front be as wide as is known."""
    own = fronts_of(made, one.front_id)
    if not own:
        return refused(made, one, "no such front", of_its_lot(made, one.front_id))
    first = own[0]
    mark = " assumed" if first.width_assumed else ""
    mended = replaced(made, one.front_id, width_m=one.number, width_assumed=False)
    return changed(mended, one, f"{first.width_m:g}{mark}", f"{one.number:g}")


def ordered(made: Applied, one: Correction) -> Applied:
    """Let a front stand elsewhere in its ring: 12.5 is between ranks 12 and 13.

    It takes the side of its new neighbours, where both have the same.
    """
    own = fronts_of(made, one.front_id)
    if not own:
        return refused(made, one, "no such front", of_its_lot(made, one.front_id))
    moved = own[0]
    others = {
        row.front.front_id: row.front
        for row in reversed(made.rows)
        if row.front
        and (row.front.block, row.front.ring) == (moved.block, moved.ring)
        and row.front.front_id != moved.front_id
    }
    places = sorted(others.values(), key=lambda front: (front.rank, front.front_id))
    before = [front for front in places if front.rank < one.number]
    after = places[len(before) :]
    sides = {front.side for front in (*before[-1:], *after[:1])}
    side = sides.pop() if len(sides) == 1 else moved.side
    for rank, front in enumerate((*before, moved, *after)):
        if front is moved:
            made = replaced(made, front.front_id, rank=rank, side=side)
        elif front.rank != rank:
            made = replaced(made, front.front_id, rank=rank)
    return changed(made, one, f"{moved.rank}", f"{len(before)}")


def heightened(made: Applied, one: Correction) -> Applied:
    """Let a building be as high as is known."""
    if not any(
        row.front and f"{row.front.block}-{row.front.lot}" == one.building_id
        for row in made.rows
    ):
        return refused(made, one, "no such building", "write it as block-lot")
    made = replace(made, heights_m={**made.heights_m, one.building_id: one.number})
    return changed(made, one, "as photographed", f"{one.number:g}")


def targeted(made: Applied, one: Correction) -> Applied:
    """Let the facade at a place of a photograph be the one it is a record of."""
    if not any(row.photo == one.photo for row in made.rows):
        return refused(made, one, "no such photo", "write it as the manifest does")
    made = replace(made, targets_px={**made.targets_px, one.photo: one.number})
    return changed(made, one, "as segmented", f"x = {one.number:g} px")


def outlined(made: Applied, one: Correction) -> Applied:
    """Let a photograph's front be what is drawn round it."""
    if not any(row.photo == one.photo for row in made.rows):
        return refused(made, one, "no such photo", "write it as the manifest does")
    made = replace(made, outlines={**made.outlines, one.photo: one.shape})
    return changed(made, one, "as segmented", one.shape)


def cornered(made: Applied, one: Correction) -> Applied:
    """Let a photograph's front have the corners that are drawn."""
    if not any(row.photo == one.photo for row in made.rows):
        return refused(made, one, "no such photo", "write it as the manifest does")
    made = replace(made, quads={**made.quads, one.photo: one.shape})
    return changed(made, one, "as rectified", one.shape)


def fronts_of(made: Applied, front_id: str) -> list[Front]:
    """List the rows' fronts of one name."""
    return [r.front for r in made.rows if r.front and r.front.front_id == front_id]


def of_its_lot(made: Applied, front_id: str) -> str:
    """Say which names the fronts of a lot have in the manifest.

    A model also names walls that were made round a corner: they are of no row.
    """
    names = dict.fromkeys(
        front.front_id
        for front in (row.front for row in made.rows)
        if front and front_id.startswith(f"{front.block}-{front.lot}-")
    )
    if not names:
        return "no lot has it: write a front_id of manifest.csv, as block-lot-side"
    shown = ", ".join([*names][:MOST_NAMES])
    return f"its lot has {shown} in manifest.csv: write one of these"


def replaced(made: Applied, front_id: str, **fields: float) -> Applied:
    """Change a front in all its rows."""
    rows = tuple(
        replace(row, front=replace(row.front, **fields))  # type: ignore[arg-type]
        if row.front and row.front.front_id == front_id
        else row
        for row in made.rows
    )
    return replace(made, rows=rows)


def changed(made: Applied, one: Correction, before: str, after: str) -> Applied:
    """Tell what a correction changed."""
    change = Change(one.row, one.what, one.subject, before, after, one.note)
    return replace(made, changes=(*made.changes, change))


def refused(made: Applied, one: Correction, reason: str, remedy: str) -> Applied:
    """Tell why a correction changed nothing."""
    detail = f"{one.what} of {one.subject[:80]}: {remedy}"
    why = Rejection(one.row, "corrections", reason, detail)
    return replace(made, rejections=(*made.rejections, why))
