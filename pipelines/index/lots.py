"""A list's rows, or file names in their place, become lots with fronts."""

import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from nostalgin_core import catalogue
from nostalgin_core.catalogue import Catalogue, Doubt, Entry, Naming
from nostalgin_core.records import Front, Rejection
from pipelines import plural
from pipelines.index import lists, manifest
from pipelines.index.cells import MOST_FRONTS, quoted
from pipelines.index.images import Nothing
from pipelines.index.names import row_name
from pipelines.index.profiles import Profile

MOST_ABSENT: Final = 6  # that are named


@dataclass(frozen=True)
class Lots:
    """The rows of a list that are asked for, their fronts, and what is wrong there."""

    entries: list[Entry]  # those of other blocks, too
    fronts: tuple[Front, ...]
    crowded: list[Rejection]
    said: list[str]
    doubts: Sequence[Doubt]

    @property
    def blocks(self) -> list[str]:
        """Name the blocks that have fronts."""
        return sorted({front.block for front in self.fronts}, key=manifest.natural)


def lots_of(read: Catalogue, blocks: Sequence[str], where: Path, own: Profile) -> Lots:
    """Take the lots that are asked for, and put their fronts in order.

    Raises:
        Nothing: if there are none.
    """
    entries, crowded = sparse(read.entries)
    wanted = of_blocks(entries, blocks, crowded, where=where)
    fronts, doubts = catalogue.fronts(wanted, named=own.naming.told)
    said = about(read.warnings, {entry.row for entry in wanted})
    return Lots(entries, tuple(fronts), crowded, said, doubts)


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


def absent(
    entries: Sequence[Entry], shown: Mapping[str, Sequence[Entry]], name: str
) -> list[str]:
    """Tell in one line which photographs a list names that are not there."""
    found = {entry.row for own in shown.values() for entry in own}
    named = {one.row: one for one in entries if one.photo}  # a corner's row once
    lost = [one for row, one in sorted(named.items()) if row not in found]
    if not lost:
        return []
    some = ", ".join(f"row {one.row} {quoted(one.photo)}" for one in lost[:MOST_ABSENT])
    more = " ..." if len(lost) > MOST_ABSENT else ""
    many = plural.of(len(lost), "photograph")
    return [f"{name}: it names {many} not among those of the folder: {some}{more}"]


def about(warnings: Sequence[str], rows: set[int]) -> list[str]:
    """Leave out what is said about rows that were not asked for."""
    named = [(re.search(r" row (\d+):", warning), warning) for warning in warnings]
    return [text for row, text in named if row is None or int(row[1]) in rows]


def from_list(listed: lists.Listing, naming: Naming) -> Catalogue:
    """Read a list.

    Raises:
        Nothing: if no row of it makes sense.
    """
    return useful(listed.read(naming), Path(listed.name))


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


def from_names(
    names: Sequence[str], folder: Path, keys: Mapping[str, tuple[str, str]]
) -> Catalogue:
    """Make a catalogue of the keys that file names or boards tell.

    Raises:
        Nothing: if no name makes sense.
    """
    rows = []
    for place, name in enumerate(names, 1):
        row = (row_name(Path(name).parent.name or folder.name), str(place))
        block, lot = keys.get(name) or row
        rows.append({"photo": name, "block": block, "lot": lot})
    return useful(catalogue.read(rows, name="file names"), folder)
