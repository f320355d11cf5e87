"""Rows of an archive's list become entries: which photo shows which lot.

Two kinds of list are read, by the names of their columns: the New York archive's own
(1940 Block Number, 1940 Lot Number, LOT FRONTAGE ...) and a plain one (photo, block,
lot, street, address, width_m, depth_m, storeys, side, order, credit). Columns that mean
nothing here are kept and named in a warning. A row that makes no sense is a rejection
that names it as a spreadsheet counts, header first. What a row's cells say is told in
`entry`.
"""

import re
import unicodedata
from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import PurePosixPath
from typing import Any, Final

from nostalgin_core.catalogue.entry import (
    KEYS,
    Entry,
    Named,
    from_cells,
    from_file_name,
    round_the_corner,
    stem,
)
from nostalgin_core.records import Rejection

ALIASES: Final[Mapping[str, tuple[str, ...]]] = {
    "photo": (
        "photo",
        "path",
        "file",
        "file_name",
        "filename",
        "image",
        "identifier",
        "id",
    ),
    "block": ("block", "tax_block", "1940_block_number"),
    "lot": ("lot", "tax_lot", "1940_lot_number"),
    "bbl": ("bbl",),
    "address": ("address", "house_no", "house_number", "1940_building_number"),
    "street": ("street", "street_name", "streetname", "1940_street_name"),
    "width_m": ("width_m",),
    "depth_m": ("depth_m",),
    "frontage_ft": ("lot_frontage", "frontage_ft"),
    "depth_ft": ("lot_depth", "depth_ft"),
    "side": ("side",),
    "order": ("order", "rank"),
    "ring": ("ring",),
    "credit": ("credit", "rights_holder", "collection"),
    "other_address": ("alternative_building_number",),
    "other_street": ("alternative_street_name",),
    "storeys": ("storeys", "stories", "floors", "number_of_floors", "numfloors"),
    "built": ("year_built",),
    "taken": ("date", "taken"),
}
UNUSED: Final = frozenset(  # the archive's columns that say nothing about place or size
    {
        *("delete", "borough", "qc", "flagged", "notes", "landmark", "roll_number"),
        *("alternative_block_number", "alternative_lot_number", "zip_code"),
        *("complete_address", "condition_hole_punch_deteriorated_tape"),
        *("year_altered1", "year_altered2"),
        # They say nothing about place or size, but are told of each photograph.
        *("rights", "rights_statement", "usage_rights", "copyright"),
        *("license", "licence", "rights_uri"),
        *("source_url", "source", "record_url", "url", "homepage"),
    }
)
HOUSES: Final = (
    "it has no column for block, lot or bbl: each street is taken for a block, and "
    "each house number of it for a lot"
)
FIRST_ROW: Final = 2
QUOTED: Final = 80  # letters
NAMED: Final = 8  # blocks of a list
LONGEST_CELL: Final = 32_767  # letters: what a cell of a spreadsheet holds


@dataclass(frozen=True, slots=True)
class Catalogue:
    """What could be read, what could not, and what else was noticed."""

    entries: tuple[Entry, ...]
    rejections: tuple[Rejection, ...]
    warnings: tuple[str, ...]


def read(
    rows: Sequence[Mapping[Any, Any]],
    *,
    name: str = "catalogue",
    first: int = FIRST_ROW,
    named: Named = from_file_name,
) -> Catalogue:
    """Read the rows of a catalogue, each by itself; empty ones are only counted.

    What stands beyond the last column is found under None or no name, as `csv` has it.
    """
    every = named_in(rows)
    columns = _columns(every)
    warnings = [
        f"{name}: column {_shown(column)} is not known; it is kept"
        for column in unknown(every)
    ]
    if KEYS.isdisjoint(columns) and "street" in columns:
        warnings.append(f"{name}: {HOUSES}")
    entries, rejections = [], []
    for number, whole in enumerate(rows, first):
        odd = None in whole or "" in whole
        row = {key: cell for key, cell in whole.items() if key} if odd else whole
        cells = {field: _text(row.get(column)) for field, column in columns.items()}
        if cells.get("photo"):
            cells["photo"] = str(row[columns["photo"]])  # blanks may be of its name
        if not any(map(_text, row.values())) and not whole.get(None):
            continue
        try:
            _check_width(whole)
            _check_lengths(row)
            entry, doubts = from_cells(cells, number, named=named)
        except ValueError as problem:
            reason, _, detail = str(problem).partition(": ")
            rejections.append(
                Rejection(f"{name} row {number}", "catalogue", reason, detail)
            )
            continue
        entries += [entry, *round_the_corner(entry, cells)]
        warnings += [f"{name} row {number}: {doubt}" for doubt in doubts]
    return Catalogue(tuple(entries), tuple(rejections), tuple(warnings))


def named_in(rows: Iterable[Mapping[Any, Any]]) -> list[Any]:
    """List the columns that have a name, in the order in which rows have them."""
    return [one for one in dict.fromkeys(chain.from_iterable(rows)) if one]


def unknown(columns: Iterable[str]) -> list[str]:
    """List the columns that mean nothing here."""
    names = list(columns)
    used = _columns(names).values()
    return [one for one in names if one not in used and plain(one) not in UNUSED]


def matched(
    entries: Sequence[Entry],
    photos: Sequence[str],
    *,
    named: Named = from_file_name,
) -> tuple[dict[str, tuple[Entry, ...]], tuple[Rejection, ...]]:
    """Find each photo's rows: those that name its path, or else just its name.

    Neither case nor suffix matters. A row whose path leads to one photo is not taken
    for a photo of the same name in another folder. A photo that no row names is matched
    by the block and lot in its own name, if the catalogue has that lot; else it is
    rejected.
    """
    paths = [_path(photo) for photo in photos]
    by_path, by_name = _by_photo(entries, set(paths))
    listed = [by_path.get(where) or by_name.get(_last(where)) or () for where in paths]
    told = {p: named(p) for p, rows in zip(photos, listed, strict=True) if not rows}
    by_lot: dict[tuple[str, str] | None, list[Entry]] = {
        lot: [] for lot in told.values() if lot
    }
    for entry in entries if by_lot else ():
        if (entry.block, entry.lot) in by_lot:
            by_lot[entry.block, entry.lot].append(entry)
    found, rejections = {}, []
    known = {entry.block for entry in entries}
    blocks = sorted(known, key=lambda one: (len(one), one))
    shown = ", ".join(blocks[:NAMED]) + (" ..." if len(blocks) > NAMED else "")
    for photo, own in zip(photos, listed, strict=True):
        lot = told.get(photo)
        rows = own or by_lot.get(lot)
        if rows:
            found[photo] = tuple(rows)
        elif lot and lot[0] not in known:
            why = "its block is not on the list"
            detail = f"it has {shown[:QUOTED]}; is it another's list?"
            rejections.append(Rejection(photo, "catalogue", why, detail))
        else:
            detail = "add a row with its name, block and lot to the catalogue"
            rejections.append(
                Rejection(photo, "catalogue", "not in the catalogue", detail)
            )
    return found, tuple(rejections)


def _by_photo(
    entries: Iterable[Entry], paths: Collection[str]
) -> tuple[Mapping[str, list[Entry]], Mapping[str, list[Entry]]]:
    """Gather the entries that name a photo, by its path and by its name alone."""
    by_path: dict[str, list[Entry]] = defaultdict(list)
    by_name: dict[str, list[Entry]] = defaultdict(list)
    for entry in entries:
        if not entry.photo:
            continue
        where = _path(entry.photo)
        where = where if where in paths else _path(entry.photo.strip())
        if where in paths:
            by_path[where].append(entry)
        if "/" not in where or where not in paths:
            by_name[_last(where)].append(entry)
    return by_path, by_name


def _columns(columns: Iterable[str]) -> dict[str, str]:
    """Tell which column holds which field; of several names the first listed wins."""
    names = {plain(name): name for name in columns}
    fields = {}
    for field, aliases in ALIASES.items():
        known = [names[alias] for alias in aliases if alias in names]
        if known:
            fields[field] = known[0]
    return fields


def _check_width(row: Mapping[Any, Any]) -> None:
    """Refuse a row with more cells than columns: its cells may be of other columns.

    Raises:
        ValueError: "reason: remedy".
    """
    surplus = [_text(cell) for cell in row.get(None) or ()]
    if any(surplus):
        beyond = ", ".join(surplus)
        raise ValueError(
            f"too many cells: {_shown(beyond)} stands beyond the last column; put "
            "texts that hold commas in quotes"
        )


def _check_lengths(row: Mapping[str, str | None]) -> None:
    """Refuse a row with a cell that no name, address or number fills.

    Raises:
        ValueError: "reason: remedy".
    """
    for column, cell in row.items():
        if cell and len(cell) > LONGEST_CELL:
            raise ValueError(
                f"cell too long: {_shown(column)} has {len(cell):,} letters, more than "
                f"{LONGEST_CELL:,}; shorten it, or look for a quote that is not closed"
            )


def _shown(words: object) -> str:
    """Quote the beginning of what may be endless."""
    text = str(words)
    return repr(text if len(text) <= QUOTED else f"{text[:QUOTED]}...")


def plain(column: object) -> str:
    """Write a column's name in small letters, one underscore between its words."""
    return re.sub(r"[^a-z0-9]+", "_", str(column).casefold()).strip("_")


def _text(cell: object) -> str:
    return str(cell if cell is not None else "").strip()


def _last(path: str) -> str:
    """Give the last name of a path that `_path` wrote."""
    return path if "/" not in path and path != "." else PurePosixPath(path).name


def _path(photo: str) -> str:
    """Write a photo's path as it is compared; some disks part letters and accents."""
    path = unicodedata.normalize("NFC", photo).replace("\\", "/")
    if "/" not in path and path.strip(" ."):
        return stem(path).strip().casefold() or "."
    whole = PurePosixPath(path)
    return (whole.parent / whole.stem.strip()).as_posix().casefold()
