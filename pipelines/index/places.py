"""Tables of places and of streets' widths, as people write them.

CITY/places.csv      block, lon, lat, bearing (may be empty); block * is the whole city
CITY/streets.csv     street, width_m
"""

from collections.abc import Mapping
from typing import Final

from nostalgin_core.address import plain_name
from nostalgin_core.catalogue import decimal
from nostalgin_core.city import Anchor
from pipelines.index import comma
from pipelines.index.cells import quoted, text

PLACES: Final = "places.csv"
STREETS: Final = "streets.csv"
WHOLE: Final = "*"  # the city: its first block
LEAST_M, MOST_M = 2.0, 150.0
NAMES: Final = {"lon": ("lon", "longitude", "lng"), "lat": ("lat", "latitude")}
SWAPPED: Final = "longitude and latitude may be swapped, or no degrees"


class NoPlaces(ValueError):  # noqa: N818 - it reads as what it is about
    """A table of places or streets that can't be used, with the remedy."""


def read(data: bytes, name: str) -> tuple[dict[str, Anchor], list[str]]:
    """Read a block's place from each row, and tell what is wrong with some rows.

    Raises:
        NoPlaces: if it is no table, lacks a column or has no row.
    """
    columns, rows = table(data)
    found = {
        word: next((n for n in own if n in columns), "") for word, own in NAMES.items()
    }
    if "block" not in columns or not all(found.values()):
        words = f"has the columns {', '.join(map(str, columns[:8]))}"
        raise NoPlaces(f"{words}: write block, lon, lat and, if known, bearing")
    anchors: dict[str, Anchor] = {}
    told = []
    for number, row in rows:
        block = text(row, "block")
        if not block or block in anchors:
            what = f"places block {block} again" if block else "names no block"
            told.append(f"{name} row {number} {what}: mend or delete the row")
            continue
        try:
            anchors[block] = anchor(row, **found)
        except ValueError as problem:
            told.append(f"{name} row {number} {problem}")
    return anchors, told


def anchor(row: comma.Cells, lon: str, lat: str) -> Anchor:
    """Read a place from its columns; the bearing may be missing.

    Raises:
        ValueError: if it is none.
    """
    return Anchor(
        degrees(row, lon, 180.0),
        degrees(row, lat, 90.0),
        degrees(row, "bearing", 360.0) if text(row, "bearing") else None,
    )


def streets(data: bytes, name: str) -> tuple[dict[str, float], list[str]]:
    """Read a street's width in metres from each row, by its casefolded name.

    Raises:
        NoPlaces: if it is no table, lacks a column or has no row.
    """
    columns, rows = table(data)
    if "street" not in columns or "width_m" not in columns:
        raise NoPlaces("lacks the columns street and width_m")
    widths: dict[str, float] = {}
    told = []
    for number, row in rows:
        try:
            wide = value(row, "width_m")
        except ValueError as problem:
            told.append(f"{name} row {number} {problem}: mend the cell")
            continue
        if LEAST_M <= wide <= MOST_M:
            widths[plain_name(text(row, "street"))] = wide
        else:
            words = f"width_m is {wide:g}, not {LEAST_M:g} to {MOST_M:g}"
            told.append(f"{name} row {number}: {words}: mend the cell")
    return widths, told


def place(asked: str) -> Anchor:
    """Read LAT,LON,BEARING; the bearing may be missing.

    Raises:
        NoPlaces: if it is none.
    """
    parts = [part.strip() for part in asked.split(",")]
    if len(parts) not in (2, 3):
        raise NoPlaces(f"--place {quoted(asked)} is not LAT,LON,BEARING in degrees")
    row = dict(zip(("lat", "lon", "bearing"), parts, strict=False))
    try:
        return anchor(row, "lon", "lat")
    except ValueError as problem:
        raise NoPlaces(f"--place {quoted(asked)}: {problem}") from problem


def written(anchors: Mapping[str, Anchor]) -> bytes:
    """Write places so that `read` gives them back."""
    rows = [
        {
            "block": block,
            "lon": one.longitude_deg,
            "lat": one.latitude_deg,
            "bearing": one.bearing_deg,
        }
        for block, one in sorted(anchors.items())
    ]
    return comma.written(["block", "lon", "lat", "bearing"], rows).encode()


def table(data: bytes) -> tuple[list[str], list[tuple[int, comma.Cells]]]:
    """Read a table's columns, and its rows by number, but for empty ones."""
    try:
        columns, rows = comma.parsed(data, ours=True)
    except comma.NoTable as problem:
        raise NoPlaces(str(problem)) from problem
    kept = [(n, row) for n, row in enumerate(rows, 2) if not comma.blank(row)]
    if not kept:
        raise NoPlaces("is empty: write a row, or leave it away")
    return columns, kept


def degrees(row: comma.Cells, name: str, most: float) -> float:
    """Read an angle.

    Raises:
        ValueError: if it is none.
    """
    angle = value(row, name)
    if not -most <= angle <= most:
        words = f"is outside the globe: {name} is {angle:g}, not {-most:g} to {most:g}"
        raise ValueError(f"{words}; {SWAPPED}")
    return angle


def value(row: comma.Cells, name: str) -> float:
    """Read a finite number of either sign."""
    written = text(row, name) if row.get(name) != 0 else "0"
    try:
        number = float(decimal(written))
    except ValueError as problem:
        words = quoted(written) if written else "empty"
        raise ValueError(f"has a {name} that is {words}, no number") from problem
    if not abs(number) < float("inf"):
        raise ValueError(f"has a {name} that is {quoted(written)}, no number")
    return number
