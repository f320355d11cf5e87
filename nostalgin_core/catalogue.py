"""Rows of an archive's list become entries: which photo shows which lot.

Two kinds of list are read, by the names of their columns: the New York archive's own
(1940 Block Number, 1940 Lot Number, LOT FRONTAGE ...) and a plain one (photo, block,
lot, street, address, width_m, depth_m, side, order, credit). Columns that mean nothing
here are kept and named in a warning. A row that makes no sense is a rejection that
names it as a spreadsheet counts, header first. Lengths of a building that is younger
than its photograph are left out. An alternative address on another street is a corner
lot's second front: the lot's depth is its width there.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import PurePosixPath
from typing import Final

from nostalgin_core.address import house_numbers
from nostalgin_core.records import Rejection

FOOT_M: Final = 0.3048
NARROWEST_FT, WIDEST_FT = 8.0, 450.0  # of a front; beyond, a digit was lost
LOT_FT: Final = 25.0  # the common lot of New York: 25 by 100 feet

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
    "built": ("year_built",),
    "taken": ("date", "taken"),
}
UNUSED: Final = frozenset(  # the archive's columns that say nothing about place or size
    {
        *("delete", "borough", "qc", "flagged", "notes", "landmark", "roll_number"),
        *("alternative_block_number", "alternative_lot_number", "zip_code"),
        *("complete_address", "condition_hole_punch_deteriorated_tape"),
        *("year_altered1", "year_altered2", "rights", "source_url"),
    }
)
TAX_PHOTO = re.compile(r"(?:^|_)(\d{5})_(\d{4})([a-z]?)$")
FIRST_ROW: Final = 2


@dataclass(frozen=True, slots=True)
class Entry:
    """One row that makes sense: a photo, a lot, or both."""

    row: int  # as a spreadsheet counts
    photo: str  # file name, with or without folder and suffix; may be empty
    block: str
    lot: str
    street: str
    address: str  # house number or range on that street, may be empty
    width_m: float | None
    depth_m: float | None
    ring: int | None
    side: int | None
    order: float | None
    credit: str


@dataclass(frozen=True, slots=True)
class Catalogue:
    """What could be read, what could not, and what else was noticed."""

    entries: tuple[Entry, ...]
    rejections: tuple[Rejection, ...]
    warnings: tuple[str, ...]


def read(
    rows: Iterable[Mapping[str, str | None]], *, name: str = "catalogue"
) -> Catalogue:
    """Read the rows of a catalogue, each by itself."""
    listed = [dict(row) for row in rows]
    columns = _columns(listed)
    warnings = [
        f"{name}: column {column!r} is not known; it is kept"
        for column in dict.fromkeys(key for row in listed for key in row)
        if column not in columns.values() and _plain(column) not in UNUSED
    ]
    entries, rejections = [], []
    for number, row in enumerate(listed, FIRST_ROW):
        cells = {field: _text(row.get(column)) for field, column in columns.items()}
        try:
            entry, doubts = _entry(cells, number)
        except ValueError as problem:
            reason, _, detail = str(problem).partition(": ")
            rejections.append(
                Rejection(f"{name} row {number}", "catalogue", reason, detail)
            )
            continue
        entries += [entry, *_round_the_corner(entry, cells)]
        warnings += [f"{name} row {number}: {doubt}" for doubt in doubts]
    return Catalogue(tuple(entries), tuple(rejections), tuple(warnings))


def from_file_name(name: str) -> tuple[str, str] | None:
    """Read block and lot from a tax photo's name: ..._00993_0008a.jpg is ("993", "8").

    The letter counts further views of the same lot.
    """
    found = TAX_PHOTO.search(PurePosixPath(name.replace("\\", "/")).stem.strip())
    return (str(int(found[1])), str(int(found[2]))) if found else None


def matched(
    entries: Sequence[Entry], photos: Sequence[str]
) -> tuple[dict[str, tuple[Entry, ...]], tuple[Rejection, ...]]:
    """Find each photo's rows: by its path, its name, or its name without suffix.

    A photo that no row names is matched by the block and lot in its own name, if the
    catalogue has that lot; else it is rejected.
    """
    by_name: dict[str, list[Entry]] = {}
    by_lot: dict[tuple[str, str], list[Entry]] = {}
    for entry in entries:
        if entry.photo:
            by_name.setdefault(_stem(entry.photo), []).append(entry)
        by_lot.setdefault((entry.block, entry.lot), []).append(entry)
    found, rejections = {}, []
    for photo in photos:
        lot = from_file_name(photo)
        rows = by_name.get(_stem(photo)) or (by_lot.get(lot, []) if lot else [])
        if rows:
            found[photo] = tuple(rows)
        else:
            detail = "add a row with its name, block and lot to the catalogue"
            rejections.append(
                Rejection(photo, "catalogue", "not in the catalogue", detail)
            )
    return found, tuple(rejections)


def feet(written: str) -> float | None:
    """Read feet and inches that a spreadsheet mangled; None where they make no sense.

    The archive wrote feet.inches, and lost hundreds on the way:

    - 98.09 is 98 feet 9 inches, 203.10 is 203 feet 10 inches (12 or more after the
      point can't be inches, and counts as a decimal fraction);
    - 20.1 is 20 feet 10 inches, for the spreadsheet dropped the last zero;
    - under 8 it is hundreds of feet: 0.60 is 60 feet, 1.25 is 125, 2.43 is 243.

    What is then under 8 feet or over 450 is no front: a digit was lost elsewhere.
    """
    found = re.fullmatch(r"(\d*)(?:\.(\d*))?", written.strip().removesuffix("'"))
    if found is None or not written.strip(" .'"):
        return None
    whole, digits = int(found[1] or 0), found[2] or ""
    if whole < NARROWEST_FT:
        length = 100.0 * float(f"{whole}.{digits or 0}")
    else:
        inches = int({"1": "10"}.get(digits, digits or "0"))
        length = whole + inches / 12 if inches < 12 else float(f"{whole}.{digits}")
    return length if NARROWEST_FT <= length <= WIDEST_FT else None


def assumed_width(address: str) -> float:
    """Guess a front's width in metres from how many house numbers it takes.

    One number is a common lot of 25 feet; each further one of the same parity adds 20,
    for later numbers were given to narrower lots.
    """
    numbers = house_numbers(address)
    more = (numbers[1] - numbers[0]) // 2 if numbers else 0
    return FOOT_M * (LOT_FT + 20.0 * min(more, 10))


def _columns(rows: Sequence[Mapping[str, str | None]]) -> dict[str, str]:
    """Tell which column holds which field; of several names the first listed wins."""
    names = {_plain(name): name for row in rows for name in row}
    fields = {}
    for field, aliases in ALIASES.items():
        known = [names[alias] for alias in aliases if alias in names]
        if known:
            fields[field] = known[0]
    return fields


def _plain(column: object) -> str:
    """Write a column's name in small letters, one underscore between its words."""
    return re.sub(r"[^a-z0-9]+", "_", str(column).casefold()).strip("_")


def _text(cell: object) -> str:
    return str(cell if cell is not None else "").strip()


def _stem(photo: str) -> str:
    return PurePosixPath(photo.replace("\\", "/")).stem.strip().casefold()


def _entry(cells: Mapping[str, str], row: int) -> tuple[Entry, list[str]]:
    """Check one row.

    Raises:
        ValueError: "reason: remedy", if it can't be used.
    """
    photo = cells.get("photo", "")
    if _leads_out(photo):
        raise ValueError(
            f"path outside the photo folder: {photo!r}; write a path inside it"
        )
    block, lot = _lot(cells, photo)
    width_m, doubts = _length(cells, "width_m", "frontage_ft")
    depth_m, more = _length(cells, "depth_m", "depth_ft")
    later = _later_building(cells)
    if later:
        width_m = depth_m = None
        doubts, more = [later], []
    order = _number(cells, "order")
    ring, side = _number(cells, "ring"), _number(cells, "side")
    entry = Entry(
        row=row,
        photo=photo,
        block=block,
        lot=lot,
        street=" ".join(cells.get("street", "").split()),
        address=cells.get("address", ""),
        width_m=width_m,
        depth_m=depth_m,
        ring=None if ring is None else int(ring),
        side=None if side is None else int(side),
        order=order,
        credit=cells.get("credit", ""),
    )
    return entry, doubts + more


def _round_the_corner(entry: Entry, cells: Mapping[str, str]) -> list[Entry]:
    """Make an entry of a corner lot's other street, if a row names one.

    An alternative with the same house number is but another name of the same street.
    """
    street = " ".join(cells.get("other_street", "").split())
    address = cells.get("other_address", "")
    same = street.casefold() == entry.street.casefold() or address == entry.address
    if not street or house_numbers(address) is None or same or entry.side is not None:
        return []
    return [
        replace(
            entry,
            street=street,
            address=address,
            width_m=entry.depth_m,
            depth_m=entry.width_m,
        )
    ]


def _leads_out(photo: str) -> bool:
    path = PurePosixPath(photo.replace("\\", "/"))
    drive = len(photo) > 1 and photo[1] == ":"
    return path.is_absolute() or drive or ".." in path.parts or "\0" in photo


def _lot(cells: Mapping[str, str], photo: str) -> tuple[str, str]:
    """Read block and lot: from their columns, the BBL, or the photo's own name."""
    block, lot = _trimmed(cells.get("block", "")), _trimmed(cells.get("lot", ""))
    bbl = re.fullmatch(r"\d-?(\d{5})-?(\d{4})", cells.get("bbl", ""))
    if not (block and lot) and bbl:
        block, lot = str(int(bbl[1])), str(int(bbl[2]))
    if not (block and lot):
        block, lot = from_file_name(photo) or (block, lot)
    if not (block and lot):
        lacking = "block" if not block else "lot"
        raise ValueError(f"no {lacking}: fill in the cell, or delete the row")
    if any(mark in block + lot for mark in "/\\\0") or len(block + lot) > 64:
        raise ValueError(
            f"nonsense block or lot: {block!r}, {lot!r}; write their numbers"
        )
    return block, lot


def _trimmed(number: str) -> str:
    """Drop leading zeros, and the ".0" that a spreadsheet adds."""
    number = re.sub(r"^(\d+)\.0+$", r"\1", number)
    return number.lstrip("0") if number.strip("0") and number.isdecimal() else number


def _length(
    cells: Mapping[str, str], metres: str, mangled: str
) -> tuple[float | None, list[str]]:
    """Read a length in metres, or in the archive's feet; doubts are no rejections."""
    if cells.get(metres):
        value = _number(cells, metres)
        if value is None or not 1.0 <= value <= 400.0:
            raise ValueError(
                f"nonsense {metres}: {cells[metres]!r}; write 1 to 400 metres"
            )
        return value, []
    written = cells.get(mangled, "")
    if not written:
        return None, []
    length_ft = feet(written)
    if length_ft is None:
        return None, [f"{mangled} {written!r} makes no sense; it is left out"]
    return round(length_ft * FOOT_M, 3), []


def _later_building(cells: Mapping[str, str]) -> str:
    """Say why the archive's lengths are not those of the building in the photograph."""
    built = re.match(r"\d{4}", cells.get("built", ""))
    taken = re.findall(r"\d{4}", cells.get("taken", ""))
    if not built or not taken or int(built[0]) <= int(taken[-1]):
        return ""
    if cells.get("width_m") or cells.get("depth_m"):
        return ""  # written for this purpose
    return f"its lengths are of a building of {built[0]}; they are left out"


def _number(cells: Mapping[str, str], field: str) -> float | None:
    written = cells.get(field, "")
    if not written:
        return None
    if not re.fullmatch(r"\d+(\.\d+)?", written):
        raise ValueError(f"nonsense {field}: {written!r}; write a number")
    return float(written)
