"""Lists of any kind become rows of the columns that `catalogue` reads.

CSV is told by no suffix in particular, JSON by its own; an address on the web, or a
JSON file that says so, is a IIIF manifest or collection, whose photographs `fetched`
brings. What was brought once is never asked for again.
"""

import json
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from nostalgin_core import catalogue
from nostalgin_core.catalogue import NAMELESS, Catalogue, Naming
from nostalgin_core.records import Rejection
from pipelines import bounded
from pipelines.index import comma, letters, names
from pipelines.index.cells import quoted
from pipelines.index.images import Nothing
from pipelines.index.web import is_web
from pipelines.store import textual

JSON: Final = (".json", ".jsonl", ".ndjson", ".geojson")
FIRST_ROW: Final = 2
FIRST_RECORD: Final = 1  # JSON has no header
KEYS: Final = frozenset(("block", "tax_block", "lot", "tax_lot", "bbl"))
PRESENTATION: Final = re.compile(r"iiif\.io/api/presentation/")

SHOWN: Final = 8  # columns that a message names

Tell = Callable[..., None]


@dataclass(frozen=True)
class Listing:
    """The rows of a list, and what of it could not be read."""

    name: str
    rows: Sequence[comma.Cells]
    rejections: tuple[Rejection, ...] = ()
    first: int = FIRST_ROW  # the number of the first row, as people count
    warnings: tuple[str, ...] = ()
    beside: Sequence[comma.Cells] = ()  # what tells of photographs and of no place

    def read(self, naming: Naming) -> Catalogue:
        """Read all rows; a photo's name may tell the lot that its row does not."""
        made = catalogue.read(
            self.rows, name=self.name, first=self.first, named=naming.told
        )
        told = (*boroughs(self), *self.warnings)
        return replace(
            made,
            rejections=(*self.rejections, *made.rejections),
            warnings=(*told, *made.warnings),
        )


def silent(event: str, words: str, **facts: Any) -> None:
    """Tell nobody."""


def opened(
    source: str | Path,
    listed: str | Path | None,
    city: str,
    *,
    naming: Naming = NAMELESS,
    encoding: str = "",
    tell: Tell = silent,
) -> tuple[Path, Listing | None]:
    """Find the folder that holds the photographs, and the list that tells of them.

    A IIIF source is brought into the city folder first; a list beside it tells where
    its photographs belong, and the manifest whose they are.

    Raises:
        Nothing: if either can't be read.
    """
    given = None if listed is None else listing(listed, city, encoding)
    name = str(source)
    if not is_web(name) and not presents(Path(source)):
        return Path(source), given
    from pipelines.index import fetched

    if not textual(name):
        raise Nothing(f"{name!r} is no address")
    folder, brought = fetched.brought(name, city, tell=tell)
    if given is not None:
        return folder, joined(given, brought)
    return folder, placed(brought, brought.name, naming)


def presents(path: Path) -> bool:
    """Tell whether a path is of a file that may be a IIIF manifest."""
    try:
        return path.suffix.casefold() == ".json" and path.is_file()
    except (OSError, ValueError):
        return False


def listing(listed: str | Path, city: str, encoding: str = "") -> Listing:
    """Read a list of whatever kind, and in whatever `encoding`, if that is told.

    Raises:
        Nothing: if it can't be read.
    """
    if is_web(str(listed)):
        from pipelines.index import fetched

        return fetched.listing(str(listed), city)
    path = Path(listed)
    try:
        data = bounded.read(path, bounded.TABLE_BYTES)
    except OSError as problem:
        raise Nothing(f"{path}: {problem.strerror}; name a CSV file") from problem
    try:
        data, guessed = letters.utf8(data, encoding)
    except letters.Garbled as problem:
        raise Nothing(f"{path} {problem}") from problem
    doubts = (f"{path.name}: {guessed}",) if guessed else ()
    if path.suffix.casefold() in JSON:
        made = of_json(data, path, city)
        return replace(made, warnings=(*doubts, *made.warnings))
    try:
        columns, rows = comma.parsed(data)
    except comma.NoTable as problem:
        raise Nothing(f"{path} {problem}") from problem
    if columns and len(catalogue.unknown(columns)) == len(columns):
        raise Nothing(f"{path} {strange(columns)}")
    return Listing(path.name, rows, warnings=doubts)


def strange(columns: Sequence[str]) -> str:
    """Name the columns of a list that has none that is known, and those wanted."""
    shown = ", ".join(quoted(one) for one in columns[:SHOWN])
    return (
        f"has no column that is known: it has {shown}; its first row is to name "
        "photo, block, lot (or bbl), and what else is told, as docs/lists.md has it"
    )


def of_json(data: bytes, path: Path, city: str) -> Listing:
    """Read a list that is JSON: objects, or a IIIF manifest.

    Raises:
        Nothing: if it is neither.
    """
    if PRESENTATION.search(data[:4096].decode(errors="replace")):
        from pipelines.index import fetched

        return fetched.listing(str(path), city)
    from pipelines.index import objects

    try:
        read = objects.rows(data, path.name)
    except objects.NoList as problem:
        raise Nothing(f"{path} {problem}") from problem
    return Listing(path.name, read.rows, read.rejections, FIRST_RECORD)


def joined(given: Listing, brought: Listing) -> Listing:
    """Let a list tell where photographs belong, and a manifest whose they are."""
    return replace(
        given,
        rejections=(*given.rejections, *brought.rejections),
        warnings=(*given.warnings, *brought.warnings),
        beside=brought.rows,
    )


def placed(listing: Listing, title: str, naming: Naming) -> Listing:
    """Give rows without a block and a lot those of their photograph's name.

    Where that tells none, the photographs stand in one row, in the order of the list.
    """
    rows = []
    for number, row in enumerate(listing.rows, 1):
        known = {catalogue.plain(name) for name, cell in row.items() if name and cell}
        if not known & KEYS:
            told = naming.guessed(row["photo"])
            block, lot = told or (names.row_name(title), str(number))
            rows.append(row | {"block": block, "lot": lot})
        else:
            rows.append(row)
    return replace(listing, rows=rows)


def boroughs(listing: Listing) -> list[str]:
    """Warn of a list of several boroughs, which number their blocks alike."""
    every = catalogue.named_in(listing.rows)
    columns = [one for one in every if str(one).strip().casefold() == "borough"]
    named = {
        str(row.get(column) or "").strip().casefold()
        for row in (listing.rows if columns else ())
        for column in columns
    } - {""}
    if len(named) < 2:
        return []
    shown = ", ".join(sorted(named)[:6])
    words = f"it has blocks of {len(named)} boroughs ({shown[:200]})"
    return [f"{listing.name}: {words}, numbered alike: index one borough at a time"]


def decoded(data: bytes) -> Any:
    """Read JSON that may be hostile.

    Raises:
        ValueError: if it is none.
    """
    try:
        return json.loads(data.decode("utf-8-sig"))
    except RecursionError as problem:
        raise ValueError("nested too deep") from problem
