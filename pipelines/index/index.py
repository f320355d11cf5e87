"""From a folder of photos and a catalogue to the manifest of a city."""

import os
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

from nostalgin_core import catalogue
from nostalgin_core.catalogue import Catalogue, Doubt, Entry
from nostalgin_core.records import Front, Rejection
from pipelines.index import lists, manifest, readings, warned, watermarks
from pipelines.index.anchors import Asked, taken
from pipelines.index.columns import cells_of
from pipelines.index.images import Nothing, images, spelt_out
from pipelines.index.lots import Lots, absent, from_list, from_names, lots_of
from pipelines.index.profiles import PROFILE, USUAL, Profile, profile
from pipelines.index.sweeping import seldom
from pipelines.index.title import cleaned
from pipelines.index.told import Told, told
from pipelines.index.witnesses import (
    Ask,
    Hearing,
    pictured,
    placed,
    with_list,
    without_list,
)
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
    doubts: tuple[Doubt, ...]
    widths_assumed: int = 0  # of the fronts
    witnesses: Mapping[str, int] = field(default_factory=dict)  # photos, by verdict
    boards: int = 0  # that were looked at

    @property
    def warnings(self) -> tuple[str, ...]:
        """Tell what is doubtful in words."""
        return tuple(one.text for one in self.doubts)

    @property
    def astray(self) -> bool:
        """Tell whether most photos found no place: the list may be another's."""
        return len(self.without_front) > MOST_HOMELESS * self.photos


@dataclass(frozen=True)
class Draft:
    """A manifest that is yet to be written, and what is written beside it."""

    encoded: tuple[bytes, bytes]  # CSV, Parquet
    files: Mapping[str, bytes]  # what was told beside, by name in the city folder
    heard: Hearing
    indexed: Indexed


@dataclass(frozen=True)
class Question:
    """What `index` is told beside the photographs and their list."""

    blocks: Sequence[str] = ()  # these alone; none: all
    credit: str = ""
    title: str = ""  # "": the city folder's name is shown
    encoding: str = ""  # of the list; "": it is found out
    places: Asked | None = None  # None: what was told of places stays
    archive: Profile | None = None  # of names and boards; None: New York's


def index(
    photos: str | Path,
    listed: str | Path | None,
    city: str,
    question: Question = Question(),
    *,
    force: bool = False,
    ask: Ask | None = None,
    tell: lists.Tell = lists.silent,
) -> Indexed:
    """Write a city folder's manifest.

    `photos` is a folder, or a IIIF source, which is brought into the city folder.
    Without a list the names tell block and lot; where they don't, boards, if there is
    somebody to `ask`; else the photos of a folder stand in one row, as they are named.
    `readings.parquet` tells what each of these says, and where they contradict each
    other. A manifest that people have mended is replaced by `force` alone, and a copy
    of it is kept.

    Raises:
        Nothing: if there is no photo, no row that makes sense, or mended ones to lose.
    """
    store = Store(city)
    mended = replaceable(store, question.credit, force=force)
    return put(store, draft(photos, listed, city, question, ask=ask, tell=tell), mended)


@seldom()
def draft(
    photos: str | Path,
    listed: str | Path | None,
    city: str,
    question: Question,
    *,
    ask: Ask | None = None,
    tell: lists.Tell = lists.silent,
) -> Draft:
    """Make a manifest as `index` does, and write none of it.

    Raises:
        Nothing: if there is no photo, or no row that makes sense.
    """
    own, blocks = question.archive or profile(USUAL), question.blocks
    ask = with_boards(ask, own)
    read_as = {"naming": own.naming, "encoding": question.encoding}
    folder, given = lists.opened(photos, listed, city, **read_as, tell=tell)
    names, unnamed = images(folder, city)
    root = os.path.abspath(folder)  # noqa: PTH100 - a link stays a link
    heard, read = first_heard(given, names, Path(root), ask, own)
    beside, whole = told_by(given, read.entries), given.name if given else ""
    del given  # its rows are held no longer
    lots = lots_of(read, blocks, Path(listed or photos), own)
    files, placeless = taken(question.places or Asked(), lots.blocks)
    shown, strangers = catalogue.matched(lots.entries, names, named=own.naming.told)
    lost = absent(lots.entries, shown, whole) if whole and not blocks else []
    if whole:
        heard = with_list(names, shown, lots.entries, ask, root, own=own)
        shown, strangers = placed(heard, shown, strangers, lots.entries)
    rows, homeless = paired(names, shown, lots.fronts, every=not blocks)
    told = {"root": root, "credit": question.credit}
    cells = cells_of(rows, shown, beside, lots.entries, **told)
    encoded = manifest.encoded(cells, title=cleaned(question.title), kept=None)
    unlisted = () if blocks else strangers
    wrong = (*unnamed, *read.rejections, *lots.crowded, *unlisted)
    said, heard_of = (
        (*lots.said, *lost, *beside.warnings),
        (*placeless, *heard.doubts()),
    )
    doubts = (*map(Doubt, said), *lots.doubts, *map(Doubt, heard_of))
    files[PROFILE] = own.toml
    files |= {watermarks.OWN: own.own_mark} if own.own_mark else {}
    wanting = {"rejections": wrong, "doubts": doubts}
    return Draft(encoded, files, heard, indexed(rows, homeless, lots, heard, **wanting))


@seldom()
def put(store: Store, made: Draft, mended: tuple[str, bytes] | None) -> Indexed:
    """Write a manifest, what is told of places, and what each witness said.

    Of a manifest that was `mended` a copy is kept.
    """
    kept = [] if mended is None else [copied(store, *mended)]
    manifest.put(store, made.encoded)
    for name, data in made.files.items():
        store.write_bytes(name, data)
    readings.write(store, pictured(store, made.heard))
    told = made.indexed
    warned.write(store, told.rejections, told.doubts)
    return replace(told, doubts=(*told.doubts, *map(Doubt, kept)))


def first_heard(
    given: lists.Listing | None,
    names: Sequence[str],
    folder: Path,
    ask: Ask | None,
    own: Profile,
) -> tuple[Hearing, Catalogue]:
    """Read a list; without one hear what tells the lots of photographs in its place.

    Raises:
        Nothing: if neither makes sense.
    """
    if given is not None:
        return Hearing(), from_list(given, own.naming)
    heard = without_list(names, ask, str(folder), own)
    return heard, from_names(names, folder, heard.keys())


def indexed(
    rows: Sequence[tuple[str, Front | None]],
    homeless: Sequence[str],
    lots: Lots,
    heard: Hearing,
    *,
    rejections: tuple[Rejection, ...],
    doubts: tuple[Doubt, ...],
) -> Indexed:
    """Count what was indexed."""
    return Indexed(
        photos=len({photo for photo, _ in rows if photo}),
        fronts=len(lots.fronts),
        blocks=len(lots.blocks),
        without_front=tuple(homeless),
        without_photo=sum(not photo for photo, _ in rows),
        widths_assumed=sum(front.width_assumed for front in lots.fronts),
        rejections=rejections,
        doubts=doubts,
        witnesses=readings.counted(heard.readings),
        boards=len(heard.boards),
    )


def with_boards(ask: Ask | None, own: Profile) -> Ask | None:
    """Ask for no boards where an archive has none.

    Raises:
        Nothing: if those of all photographs were asked for.
    """
    if own.boarded or ask is None:
        return ask
    if ask.which == "all":
        raise Nothing(
            f"profile {own.name} says that there are no boards: leave out --boards "
            "all, or write present = true below [board]"
        )
    return None


def replaceable(store: Store, credit: str, *, force: bool) -> tuple[str, bytes] | None:
    """Give what people have written in the manifest, if it may be replaced.

    Raises:
        Nothing: if it may not, or the credit can't be written.
    """
    if not textual(credit):
        raise Nothing(f"--credit {spelt_out(credit)} is not UTF-8: write it anew")
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


def told_by(listed: lists.Listing | None, entries: Sequence[Entry]) -> Told:
    """Gather what a list tells of photographs beside their place."""
    if listed is None:
        return Told({})
    reserved, beside = manifest.SCHEMA.names, listed.beside
    named = {"name": listed.name, "first": listed.first, "beside": beside}
    return told(listed.rows, entries, reserved=reserved, **named)


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
