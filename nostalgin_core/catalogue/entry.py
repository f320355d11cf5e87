"""What one row of an archive's list says: an `Entry`, or why it makes no sense.

Its cells come by field, whatever their columns are called (`catalogue`). Block and lot
are read from their columns, the BBL, or the photo's own name; in a list without such
columns a street is a block, and a house of it a lot. An alternative address on
another street is a corner lot's second front: the lot's depth is its width there.
"""

import hashlib
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import PurePosixPath
from typing import Final

from nostalgin_core.address import house_numbers, plain_name
from nostalgin_core.catalogue.lengths import (
    count,
    floors,
    later_building,
    length,
    number,
)

Named = Callable[[str], tuple[str, str] | None]  # what a file's name tells
KEYS: Final = frozenset(("block", "lot", "bbl"))  # fields that tell a lot
LONGEST: Final = 64  # letters of block and lot
HARMLESS: Final = str.maketrans(
    {"/": "\u2044", "\\": "\u2044", "-": "\u2013", "\0": " "}
)
TAX_PHOTO: Final = re.compile(r"(?:^|_)(\d{5})_(\d{4})([a-z]?)$")


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
    built: str  # the year of the building
    storeys: float | None = None  # of the building, as the list counts them


def from_file_name(name: str) -> tuple[str, str] | None:
    """Read block and lot from a tax photo's name: ..._00993_0008a.jpg is ("993", "8").

    The letter counts further views of the same lot.
    """
    found = TAX_PHOTO.search(stem(name.replace("\\", "/")).strip())
    return (str(int(found[1])), str(int(found[2]))) if found else None


def from_cells(
    cells: Mapping[str, str], row: int, *, named: Named = from_file_name
) -> tuple[Entry, list[str]]:
    """Make an entry of one row's cells, and list what is doubtful about them.

    Raises:
        ValueError: "reason: remedy", if it can't be used.
    """
    photo = cells.get("photo", "")
    if not inside(photo):
        raise ValueError(
            f"path outside the photo folder: {photo!r}; write a path inside it"
        )
    block, lot = _lot(cells, photo, named)
    width_m, doubts = length(cells, "width_m", "frontage_ft")
    depth_m, more = length(cells, "depth_m", "depth_ft")
    later = later_building(cells)
    storeys, odd = floors(cells)
    if later:
        width_m = depth_m = storeys = None
        doubts, more, odd = [later], [], []
    order = number(cells, "order")
    ring, side = count(cells, "ring"), count(cells, "side")
    made = Entry(
        row=row,
        photo=photo,
        block=block,
        lot=lot,
        street=" ".join(cells.get("street", "").split()),
        address=cells.get("address", ""),
        width_m=width_m,
        depth_m=depth_m,
        ring=ring,
        side=side,
        order=order,
        credit=cells.get("credit", ""),
        built="" if later else cells.get("built", ""),
        storeys=storeys,
    )
    return made, doubts + more + odd


def round_the_corner(entry: Entry, cells: Mapping[str, str]) -> list[Entry]:
    """Make an entry of a corner lot's other street, if a row names one.

    An alternative with the same house number is but another name of the same street.
    """
    street = " ".join(cells.get("other_street", "").split())
    address = cells.get("other_address", "")
    same = plain_name(street) == plain_name(entry.street) or address == entry.address
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


def stem(path: str) -> str:
    """Give a path's last name without its suffix, as `pathlib` does, ten times faster.

    Of an archive's photos a million are looked at.
    """
    if path.endswith((".", "/")):
        return PurePosixPath(path).stem
    name = path[path.rfind("/") + 1 :]
    dot = name.rfind(".")
    return name[:dot] if dot > 0 else name


def _lot(cells: Mapping[str, str], photo: str, named: Named) -> tuple[str, str]:
    """Read block and lot: from their columns, the BBL, or the photo's own name."""
    block, lot = _trimmed(cells.get("block", "")), _trimmed(cells.get("lot", ""))
    bbl = re.fullmatch(r"\d-?(\d{5})-?(\d{4})", cells.get("bbl", ""))
    if not (block and lot) and bbl:
        block, lot = str(int(bbl[1])), str(int(bbl[2]))
    if not (block and lot):
        block, lot = named(photo) or (block, lot)
    if not (block and lot) and KEYS.isdisjoint(cells):
        block, lot = _house(cells, photo) or (block, lot)
    if not (block and lot):
        lacking = "block" if not block else "lot"
        if KEYS.isdisjoint(cells) and "street" in cells:
            lacking = "street"
        raise ValueError(f"no {lacking}: fill in the cell, or delete the row")
    if any(mark in block + lot for mark in "/\\\0") or len(block + lot) > LONGEST:
        raise ValueError(
            f"nonsense block or lot: {block!r}, {lot!r}; write their numbers"
        )
    return block, lot


def _house(cells: Mapping[str, str], photo: str) -> tuple[str, str] | None:
    """Take a street for a block and a house for a lot, where a list knows of neither.

    A house without a number is known by its photograph. What parts a key, or a path,
    is written so that it parts none.
    """
    written = cells.get("address", "").translate(HARMLESS)
    number = " ".join(written.split())
    street = plain_name(cells.get("street", "")).translate(HARMLESS)
    house = f"No. {number}" if number else stem(photo).strip().translate(HARMLESS)
    if len(street + house) > LONGEST:
        house = hashlib.sha256(house.encode()).hexdigest()[:12]
    return (street, house) if street and house else None


def _trimmed(number: str) -> str:
    """Drop leading zeros, and the ".0" that a spreadsheet adds."""
    if "." in number:
        number = re.sub(r"^(\d+)\.0+$", r"\1", number)
    return number.lstrip("0") if number.strip("0") and number.isdecimal() else number


def inside(photo: str, *, windows: bool = False) -> bool:
    """Tell whether a path stays within the folder it is relative to.

    Drives and backslashes lead somewhere on `windows` alone; elsewhere they are letters
    of a name.
    """
    if not windows and "/" not in photo and "\0" not in photo:
        return photo != ".."  # as nearly all are
    path = PurePosixPath(photo.replace("\\", "/") if windows else photo)
    drive = windows and len(photo) > 1 and photo[1] == ":"
    return not (path.is_absolute() or drive or ".." in path.parts or "\0" in photo)
