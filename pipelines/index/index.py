"""From a folder of photos and a catalogue to the manifest of a city."""

import hashlib
import os
import re
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from nostalgin_core import catalogue
from nostalgin_core.catalogue import Catalogue, Entry, from_file_name
from nostalgin_core.records import Front, Rejection
from pipelines import bounded
from pipelines.index import comma, manifest
from pipelines.index.anchors import Asked, taken
from pipelines.index.cells import MOST_FRONTS
from pipelines.index.images import Nothing, images, spelt_out
from pipelines.index.title import cleaned
from pipelines.store import Store, textual

LONGEST: Final = 48  # letters of a folder that names a block
# 993_8a, 993-8, block 993 lot 8: the two numbers at the end, with a view's letter
MOST_HOMELESS: Final = 0.5  # of the photos
BLOCK_AND_LOT: Final = re.compile(r"(?:^|\D)(\d{1,5})\D{1,7}?(\d{1,4})[a-z]?$")


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

    @property
    def astray(self) -> bool:
        """Tell whether most photos found no place: the list may be another's."""
        return len(self.without_front) > MOST_HOMELESS * self.photos


def index(
    photos: Path,
    listed: Path | None,
    city: str,
    *,
    blocks: Sequence[str] = (),
    credit: str = "",
    title: str = "",
    force: bool = False,
    places: Asked | None = None,
) -> Indexed:
    """Write a city folder's manifest; without a `title` its folder's name is shown.

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
    names, unnamed = images(photos, city)
    read = from_names(names, photos) if listed is None else from_csv(listed)
    entries, crowded = sparse(read.entries)
    wanted = of_blocks(entries, blocks, crowded, where=listed or photos)
    fronts, doubts = catalogue.fronts(wanted)
    named = {front.block for front in fronts}
    files, placeless = taken(places or Asked(), sorted(named, key=manifest.natural))
    shown, strangers = catalogue.matched(entries, names)
    rows, homeless = paired(names, shown, fronts, every=not blocks)
    root = os.path.abspath(photos)  # noqa: PTH100 - a link stays a link
    credits_of = {name: credit or first_credit(own) for name, own in shown.items()}
    more = told(entries, shown)
    cells = [
        manifest.row_of(photo, front, root=root, credit=credits_of.get(photo, credit))
        | more(photo, front)
        for photo, front in rows
    ]
    kept = [] if mended is None else [copied(store, *mended)]
    manifest.write(store, cells, title=cleaned(title))
    for name, data in files.items():
        store.write_bytes(name, data)
    return Indexed(
        photos=len({photo for photo, _ in rows if photo}),
        fronts=len(fronts),
        blocks=len(named),
        without_front=tuple(homeless),
        without_photo=sum(not photo for photo, _ in rows),
        rejections=(
            *unnamed,
            *read.rejections,
            *crowded,
            *(strangers if not blocks else ()),
        ),
        warnings=(
            *about(read.warnings, {e.row for e in wanted}),
            *doubts,
            *placeless,
            *kept,
        ),
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


def told(
    entries: Sequence[Entry], shown: Mapping[str, Sequence[Entry]]
) -> Callable[[str, Front | None], dict[str, str]]:
    """Tell what a list says beside place and size: columns that some row fills.

    `date` and `source` are a photo's, `year` is a building's.
    """
    built = {(one.block, one.lot): one.built for one in reversed(entries) if one.built}
    some = {
        "date": any(one.taken for one in entries),
        "source": any(one.source for one in entries),
        "year": bool(built),
    }

    def of(photo: str, front: Front | None) -> dict[str, str]:
        own = shown.get(photo, ())
        lot = (front.block, front.lot) if front else ("", "")
        cells = {
            "date": next((one.taken for one in own if one.taken), ""),
            "source": next((one.source for one in own if one.source), ""),
            "year": built.get(lot, ""),
        }
        return {name: cell for name, cell in cells.items() if some[name]}

    return of


def first_credit(entries: Sequence[Entry]) -> str:
    """Take the credit of the first row that gives one."""
    return next((entry.credit for entry in entries if entry.credit), "")


def from_csv(path: Path) -> Catalogue:
    """Read a catalogue.

    Raises:
        Nothing: if it can't be read, or no row of it makes sense.
    """
    try:
        _, rows = comma.parsed(bounded.read(path, bounded.TABLE_BYTES))
    except OSError as problem:
        raise Nothing(f"{path}: {problem.strerror}; name a CSV file") from problem
    except comma.NoTable as problem:
        raise Nothing(f"{path} {problem}") from problem
    read = catalogue.read(rows, name=path.name)
    return useful(read, path)


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


def row_name(folder: str) -> str:
    """Call a row of photos after its folder; a name that is no block's is replaced."""
    if len(folder) <= LONGEST and not set(folder) & set("/\\\0") and folder.strip():
        return folder
    return f"row {hashlib.sha256(os.fsencode(folder)).hexdigest()[:12]}"


def block_and_lot(name: str) -> tuple[str, str] | None:
    """Read block and lot from a file name, if it tells both."""
    exact = from_file_name(name)
    if exact is not None:
        return exact
    found = BLOCK_AND_LOT.search(Path(name).stem.strip().casefold())
    return (str(int(found[1])), str(int(found[2]))) if found else None


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
