"""What a list tells of a photograph beside its place: whose it is, when it was taken.

Rights, licence, date and source travel under one name each, whatever a list calls them,
from the list to the manifest, the site and the model. Columns that mean nothing here
are kept under their own names.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain
from typing import Any, Final

from nostalgin_core import catalogue
from nostalgin_core.catalogue import Entry
from pipelines.index import dates

TOLD: Final[Mapping[str, tuple[str, ...]]] = {
    "rights": ("rights", "rights_statement", "usage_rights", "copyright"),
    "license": ("license", "licence", "rights_uri"),
    "date": ("date", "taken"),
    "source_url": ("source_url", "source", "record_url", "url", "homepage"),
}
AS_WRITTEN: Final = "date_as_written"  # where it is no EDTF
TELLING: Final = (*TOLD, AS_WRITTEN)  # columns that tell of photographs
LONGEST_NAME: Final = 100  # letters of a column that is kept
MOST_COLUMNS: Final = 200  # that are kept
MOST_TOLD: Final = 5  # dates that are no EDTF
MOST_SAME: Final = 4096  # rows that are remembered, for others may tell the same
OURS: Final = "list_"  # before a column that the manifest has for itself


@dataclass(frozen=True)
class Told:
    """What is told by each row, and what is doubtful about it."""

    by_row: Mapping[int, dict[str, str]]
    by_photo: dict[str, dict[str, str]] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    def of(self, photo: str, entries: Sequence[Entry]) -> dict[str, str]:
        """Give what is told of a photograph by its rows, the first that tells a thing.

        Without a photograph it is what the rows tell.
        """
        found = self.by_photo.get(stem(photo), {}) if photo else {}
        for entry in reversed(entries):
            found = found | self.by_row.get(entry.row, {})
        return found


def told(
    rows: Sequence[Mapping[Any, Any]],
    entries: Sequence[Entry],
    *,
    reserved: Sequence[str],
    name: str,
    first: int,
    beside: Sequence[Mapping[Any, Any]] = (),
) -> Told:
    """Gather what a list's rows tell; `reserved` are columns of the manifest's own.

    `beside` are rows that tell of photographs by name, and of no place.
    """
    columns = catalogue.named_in(chain(rows, beside))
    plain = {catalogue.plain(column): column for column in columns}
    known = {
        field: next((plain[alias] for alias in aliases if alias in plain), None)
        for field, aliases in TOLD.items()
    }
    taken = {column for column in known.values() if column is not None}
    unknown = [one for one in catalogue.unknown(columns) if one not in taken]
    kept = [one for one in unknown if len(one) <= LONGEST_NAME][:MOST_COLUMNS]
    names = {one: _own(one, {*reserved, *TOLD, AS_WRITTEN}) for one in kept}
    reader = Reader(names, known)
    same: dict[tuple[tuple[str, str], ...], dict[str, str]] = {}  # as most rows tell
    by_row = {}
    for entry in entries:
        if len(same) > MOST_SAME:
            same.clear()
        read = reader.read(rows[entry.row - first])
        by_row[entry.row] = same.setdefault(tuple(read.items()), read)
    by_photo = {stem(text(row.get("photo"))): reader.read(row) for row in beside}
    warnings = reader.undated(name)
    if len(kept) < len(unknown):
        lost = len(unknown) - len(kept)
        limits = f"{MOST_COLUMNS} columns with names of {LONGEST_NAME} letters"
        warnings.append(f"{name}: {lost} columns are not kept: at most {limits} are")
    return Told(by_row, by_photo, tuple(warnings))


@dataclass
class Reader:
    """Reads rows by their columns, and counts the dates that are none."""

    names: Mapping[str, str]  # of columns that are kept: theirs, ours
    known: Mapping[str, str | None]  # of what is told under one name: ours, theirs
    strange: Counter[str] = field(default_factory=Counter)

    def read(self, row: Mapping[Any, Any]) -> dict[str, str]:
        """Read what a row tells; what is empty tells nothing."""
        cells = {ours: text(row.get(theirs)) for theirs, ours in self.names.items()}
        for field_name, column in self.known.items():
            cells[field_name] = text(row.get(column)) if column else ""
        written = cells["date"]
        cells["date"] = dates.edtf(written) or "" if written else ""
        if written and not cells["date"]:
            cells[AS_WRITTEN] = written
            self.strange[written] += 1
        return {one: cell for one, cell in cells.items() if cell}

    def undated(self, name: str) -> list[str]:
        """Tell which dates are no EDTF, and how often they are written."""
        return [
            f"{name}: the date {written[:40]!r} ({count} rows) is no EDTF; it is kept "
            "as it is written: write 1940, 1939/1941 or 1940~"
            for written, count in sorted(self.strange.items())[:MOST_TOLD]
        ]


def stem(photo: str) -> str:
    """Write a photograph's name as names are compared: without folder and suffix."""
    return catalogue.stem(photo.strip().replace("\\", "/")).casefold()


def text(cell: Any) -> str:
    """Read a cell."""
    return str(cell if cell is not None else "").strip()


def _own(column: str, reserved: set[str]) -> str:
    """Call a column as its list does, if the manifest has no such column itself."""
    return f"{OURS}{column}" if column in reserved else column
