"""From a folder of photos and a catalogue to the manifest of a city."""

import os
import re
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from nostalgin_core import catalogue
from nostalgin_core.catalogue import Catalogue, Entry
from nostalgin_core.records import Front, Rejection
from pipelines.index import lists, manifest
from pipelines.index.anchors import Asked, taken
from pipelines.index.cells import MOST_FRONTS
from pipelines.index.images import Nothing, images, spelt_out
from pipelines.index.names import block_and_lot, row_name
from pipelines.index.title import cleaned
from pipelines.index.told import Told, told
from pipelines.store import Store, textual

MOST_HOMELESS: Final = 0.5  # of the photos


@dataclass(frozen=True)
class Indexed:
    """What a manifest was made of."""

    photos: int
    fronts: int
    blocks: int
    without_front: tuple[str, ...]
    without_photo: int
    rejections: tuple[Rejection, ...]
    warnings: tuple[str, ...]
    widths_assumed: int = 0  # of the fronts

    @property
    def astray(self) -> bool:
        """Tell whether most photos found no place: the list may be another's."""
        return len(self.without_front) > MOST_HOMELESS * self.photos


def index(
    photos: str | Path,
    listed: str | Path | None,
    city: str,
    *,
    blocks: Sequence[str] = (),
    credit: str = "",
    title: str = "",
    force: bool = False,
    places: Asked | None = None,
    tell: lists.Tell = lists.silent,
) -> Indexed:
    """Write a city folder's manifest; without a `title` its folder's name is shown.

    `photos` is a folder, or a IIIF source, which is brought into the city folder.
    Without a catalogue the file names tell block and lot; where they don't, the photos
    of a folder stand in one row, in the order of their names. A manifest that people
    have mended is replaced by `force` alone, and a copy of it is kept. What an earlier
    one was told of `places` stays, unless this one is told anew.

    Raises:
        Nothing: if there are no photos, no row of the catalogue makes sense, or a
            mended manifest would be lost.
    """
    if not textual(credit):
        raise Nothing(f"--credit {spelt_out(credit)} is not UTF-8: write it anew")
    store = Store(city)
    mended = replaceable(store, force=force)
    folder, given = lists.opened(photos, listed, city, tell=tell)
    names, unnamed = images(folder, city)
    read = from_names(names, folder) if given is None else from_list(given)
    beside = told_by(given, read.entries)
    entries, crowded = sparse(read.entries)
    wanted = of_blocks(entries, blocks, crowded, where=Path(listed or photos))
    fronts, doubts = catalogue.fronts(wanted)
    named = {front.block for front in fronts}
    files, placeless = taken(places or Asked(), sorted(named, key=manifest.natural))
    shown, strangers = catalogue.matched(entries, names)
    rows, homeless = paired(names, shown, fronts, every=not blocks)
    root = os.path.abspath(folder)  # noqa: PTH100 - a link stays a link
    credits_of = {name: credit or first_credit(own) for name, own in shown.items()}
    year = years(entries)
    cells = [
        manifest.row_of(photo, front, root=root, credit=credits_of.get(photo, credit))
        | beside.of(photo, shown.get(photo, ()), front)
        | year(front)
        for photo, front in rows
    ]
    kept = [] if mended is None else [copied(store, *mended)]
    columns = {column for row in cells for column in row} - {*manifest.SCHEMA.names}
    manifest.write(store, cells, title=cleaned(title), kept=columns)
    for name, data in files.items():
        store.write_bytes(name, data)
    said = about(read.warnings, {entry.row for entry in wanted})
    unlisted = strangers if not blocks else ()
    return Indexed(
        photos=len({photo for photo, _ in rows if photo}),
        fronts=len(fronts),
        blocks=len(named),
        without_front=tuple(homeless),
        without_photo=sum(not photo for photo, _ in rows),
        widths_assumed=sum(front.width_assumed for front in fronts),
        rejections=(*unnamed, *read.rejections, *crowded, *unlisted),
        warnings=(*said, *beside.warnings, *doubts, *placeless, *kept),
    )


def of_blocks(
    entries: Sequence[catalogue.Entry],
    blocks: Sequence[str],
    crowded: Sequence[Rejection],
    *,
    where: Path,
) -> list[catalogue.Entry]:
    """Take the entries of the blocks that are asked for, or of all.

    Raises:
        Nothing: if there are none.
    """
    wanted = [entry for entry in entries if not blocks or entry.block in blocks]
    if wanted:
        return wanted
    if crowded:
        raise Nothing(f"{crowded[0].key}: {crowded[0].reason}: {crowded[0].detail}")
    raise Nothing(f"{where} lists none of the blocks {', '.join(blocks)}")


def replaceable(store: Store, *, force: bool) -> tuple[str, bytes] | None:
    """Give what people have written in the manifest, if it may be replaced.

    Raises:
        Nothing: if it may not.
    """
    try:
        mended = manifest.mended_by_hand(store)
    except manifest.Unusable as problem:
        raise Nothing(str(problem)) from problem
    if mended is not None and not force:
        raise Nothing(
            f"{store.root}/{mended[0]} is not as index wrote it, but mended by hand or "
            "cut off: with --force it is replaced, and a copy is kept"
        )
    return mended


def copied(store: Store, name: str, data: bytes) -> str:
    """Keep a copy of a mended manifest, and say so."""
    kept = manifest.keep_copy(store, name, data)
    return f"{kept} keeps the manifest that was mended by hand"


def sparse(entries: Sequence[Entry]) -> tuple[list[Entry], list[Rejection]]:
    """Leave out blocks of more fronts than a manifest can count: they are no blocks."""
    lots: dict[str, set[tuple[str, str]]] = defaultdict(set)
    for entry in entries:
        lots[entry.block].add((entry.lot, entry.street))
    detail = (
        f"more than {MOST_FRONTS:,}, so it is none: is it the right column? without a "
        "catalogue, files are named by block and lot, or lie in more folders"
    )
    crowded = [
        Rejection(f"block {block}", "catalogue", f"{len(own):,} lots", detail)
        for block, own in lots.items()
        if len(own) > MOST_FRONTS
    ]
    kept = [one for one in entries if len(lots[one.block]) <= MOST_FRONTS]
    return kept, crowded


def about(warnings: Sequence[str], rows: set[int]) -> list[str]:
    """Leave out what is said about rows that were not asked for."""
    named = [(re.search(r" row (\d+):", warning), warning) for warning in warnings]
    return [text for row, text in named if row is None or int(row[1]) in rows]


def years(entries: Sequence[Entry]) -> Callable[[Front | None], dict[str, str]]:
    """Tell when a front's building was built, where a list tells that of any."""
    built = {(one.block, one.lot): one.built for one in reversed(entries) if one.built}

    def of(front: Front | None) -> dict[str, str]:
        lot = (front.block, front.lot) if front else ("", "")
        return {"year": built.get(lot, "")} if built else {}

    return of


def first_credit(entries: Sequence[Entry]) -> str:
    """Take the credit of the first row that gives one."""
    return next((entry.credit for entry in entries if entry.credit), "")


def from_list(listed: lists.Listing) -> Catalogue:
    """Read a list.

    Raises:
        Nothing: if no row of it makes sense.
    """
    return useful(listed.read(), Path(listed.name))


def told_by(listed: lists.Listing | None, entries: Sequence[Entry]) -> Told:
    """Gather what a list tells of photographs beside their place."""
    if listed is None:
        return Told({}, {})
    reserved, beside = manifest.SCHEMA.names, listed.beside
    named = {"name": listed.name, "first": listed.first, "beside": beside}
    return told(listed.rows, entries, reserved=reserved, **named)


def useful(read: Catalogue, path: Path) -> Catalogue:
    """Insist on one row that makes sense; else name the first that makes none.

    Raises:
        Nothing: if there is none.
    """
    if read.entries:
        return read
    told = [f"{one.key}: {one.reason}: {one.detail}" for one in read.rejections[:1]]
    why = "".join(told) or "it is empty"
    raise Nothing(f"{path} has no row that makes sense; {why}")


def from_names(names: Sequence[str], folder: Path) -> Catalogue:
    """Make a catalogue of what the file names tell.

    Raises:
        Nothing: if no name makes sense.
    """
    told = {name: block_and_lot(name) for name in names}
    rows = []
    for place, name in enumerate(names, 1):
        row = (row_name(Path(name).parent.name or folder.name), str(place))
        block, lot = told[name] or row
        rows.append({"photo": name, "block": block, "lot": lot})
    return useful(catalogue.read(rows, name="file names"), folder)


def paired(
    names: Sequence[str],
    shown: dict[str, tuple[Entry, ...]],
    fronts: Sequence[Front],
    *,
    every: bool,
) -> tuple[list[tuple[str, Front | None]], list[str]]:
    """Pair each photo with all fronts of its lot; tell which photos have none.

    Fronts without a photo get a row too, and so, if `every` photo is wanted, do photos
    without a front.
    """
    of_lot: dict[tuple[str, str], list[Front]] = defaultdict(list)
    for front in fronts:
        of_lot[front.block, front.lot].append(front)
    rows: list[tuple[str, Front | None]] = []
    homeless = []
    for name in names:
        lots = dict.fromkeys((entry.block, entry.lot) for entry in shown.get(name, ()))
        own = [front for lot in lots for front in of_lot.get(lot, ())]
        rows += [(name, front) for front in own]
        if not own and every:
            rows.append((name, None))
            homeless.append(name)
    seen = {front.front_id for _, front in rows if front is not None}
    rows += [("", front) for front in fronts if front.front_id not in seen]
    return rows, homeless
