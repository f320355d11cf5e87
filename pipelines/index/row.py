"""A manifest's rows, checked one by one: a bad one is named, and spoils no other."""

import dataclasses
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from nostalgin_core.catalogue import inside
from nostalgin_core.records import Front, Rejection
from pipelines.index import comma
from pipelines.index.cells import as_written, front_from, quoted, text
from pipelines.index.told import AS_WRITTEN, TOLD
from pipelines.store import secretive

CSV: Final = "manifest.csv"
LONGEST_CELL: Final = 32_767  # letters: what a cell of a spreadsheet holds


@dataclass(frozen=True)
class Row:
    """One photo that may show one front; either may be missing, not both."""

    number: int  # as a spreadsheet counts
    root: str
    photo: str
    front: Front | None
    credit: str
    cells: dict[str, Any] = field(compare=False)  # all that was written in the row

    @property
    def told(self) -> dict[str, str]:
        """Give what is told of the photograph beside its place: rights, licence..."""
        known = {name: text(self.cells, name) for name in (*TOLD, AS_WRITTEN)}
        known["source_url"] = self.source
        return {name: words for name, words in known.items() if words}

    @property
    def key(self) -> str:
        """Name the row in rejections."""
        return f"{CSV} row {self.number}"

    @property
    def licence(self) -> str:
        """Tell under which licence the photo may be shown, if somebody wrote it."""
        said = (text(self.cells, name) for name in ("rights", "license"))
        return "; ".join(word for word in said if word)

    @property
    def source(self) -> str:
        """Give the address of the archive's record of the photo, if that is a page."""
        address = text(self.cells, "source_url")
        return address if address.lower().startswith(("https://", "http://")) else ""


@dataclass(frozen=True)
class Refused:
    """Why a row can't be used, and the photo that it names all the same."""

    why: Rejection
    root: str = ""
    photo: str = ""  # empty: it names none

    def __bool__(self) -> bool:
        """Be false, as a rejection is."""
        return False


def contradictions(rows: Sequence[Row]) -> list[str]:
    """Name the rows that tell a front otherwise than an earlier row, which counts."""
    first: dict[tuple[str, str], Row] = {}
    told = []
    for row in rows:
        if row.front is None:
            continue
        known = first.setdefault((row.front.block, row.front.front_id), row)
        if known.front is not None and known.front != row.front:
            differing = [
                one.name
                for one in dataclasses.fields(Front)
                if getattr(known.front, one.name) != getattr(row.front, one.name)
            ]
            told.append(
                f"{row.key}: {', '.join(differing)} of front {row.front.front_id} not "
                f"as in row {known.number}, which counts; mend all the front's rows"
            )
    return told


def usable(number: int, cells: comma.Cells) -> Row | Refused:
    """Check one row, and name the row and the remedy if it can't be used."""
    one = read_row(number, cells)
    if isinstance(one, Row):
        return one
    root = text(cells, "root")
    return Refused(one, "" if secretive(root) else root, text(cells, "photo"))


def read_row(number: int, cells: comma.Cells) -> Row | Rejection:
    """Read one row, or tell why it can't be used."""
    name = f"{CSV} row {number}"
    if None in cells:
        beyond = quoted(",".join(cells[None]))
        return Rejection(name, "manifest", "too many cells", f"{beyond}: quote commas")
    for column, cell in cells.items():
        if isinstance(cell, str) and len(cell) > LONGEST_CELL:
            told = f"{column!r} has {len(cell):,} letters, more than {LONGEST_CELL:,}"
            detail = f"{told}: shorten it, or look for a quote that is not closed"
            return Rejection(name, "manifest", "cell too long", detail)
    photo = as_written(cells, "photo")
    if not inside(photo, windows=os.sep == "\\"):
        words = quoted(photo)
        detail = f"{words} leads out of the photo folder: write a path inside it"
        return Rejection(name, "manifest", "path outside the photo folder", detail)
    try:
        front = front_from(cells)
    except ValueError as problem:
        return Rejection(name, "manifest", "nonsense cell", f"{problem}: mend the cell")
    if front is None and not photo:
        return Rejection(name, "manifest", "empty row", "name a photo or a front")
    root, credit = as_written(cells, "root"), text(cells, "credit")
    return Row(number, root, photo, front, credit, cells)
