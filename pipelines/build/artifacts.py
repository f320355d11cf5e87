"""What the artifacts of `matte`, `rectify` and `borrow` hold, and how it is read."""

import json
from dataclasses import asdict, dataclass
from typing import Any, Final

import pyarrow as pa

from nostalgin_core import evidence, inpaint, rectify, steps
from nostalgin_core.borrow import Borrowed
from nostalgin_core.records import (
    Elevation,
    Facade,
    Matted,
    Occluder,
    Photo,
    Rejection,
    Seen,
    Standpoint,
)
from pipelines.store import tables


def joined(*records: type) -> pa.Schema:
    """Give a schema with the columns of several records, each column once."""
    columns = {field.name: field for one in records for field in tables.schema(one)}
    return pa.schema(list(columns.values()))


MATTED: Final = joined(Facade, Occluder)
WATERMARK: Final = pa.field("watermark", pa.string())  # words of one taken out
RECTIFIED: Final = joined(Elevation, Seen, Standpoint, Rejection).append(WATERMARK)
THUMBNAIL: Final = pa.schema([pa.field("picture", pa.binary())])
LENT: Final = ["photos", "fits", "unseen", "left", "front"]
BORROWED: Final = pa.schema(
    [
        *tables.schema(Elevation),
        pa.field("sources", pa.binary()),  # a PNG: 0, or a place in `photos`, from 1
        pa.field("photos", pa.list_(pa.string())),
        pa.field("fits", pa.string()),  # of all lenders, as JSON
        pa.field("unseen", pa.int64()),  # texels that the own photograph does not show
        pa.field("left", pa.int64()),  # of these, that no other one showed
        pa.field("front", pa.int64()),  # texels of the front
    ]
)
NUMBERS: Final = [
    *(field.name for field in joined(Seen, Standpoint, Rejection)),
    WATERMARK.name,
]


def matted_table(result: Matted) -> pa.Table:
    """Write facades and occluders into one table; occluders have a category."""
    rows = [tables.to_row(one) for one in (*result.facades, *result.occluders)]
    return pa.Table.from_pylist(rows, MATTED)


def matted_from(table: pa.Table) -> Matted:
    """Read back what `matted_table` wrote."""
    rows = table.to_pylist()
    return Matted(
        tuple(tables.from_row(Facade, r) for r in rows if r["category"] is None),
        tuple(tables.from_row(Occluder, r) for r in rows if r["category"] is not None),
    )


def rectified_table(
    picture: Photo,
    result: Matted,
    views: tuple[Elevation | Rejection, ...],
    watermark: str = "",
) -> pa.Table:
    """Write a row for each facade: its elevation and numbers, or its rejection.

    A `watermark` that was taken out of the elevations is named by its words.
    """
    frame, shape = picture.frame, picture.image.shape
    rows: list[dict[str, Any]] = []
    for facade, view in zip(result.facades, views, strict=True):
        row = tables.to_row(view)
        if isinstance(view, Elevation):
            stood = rectify.standpoint(view, frame=frame, shape=(shape[0], shape[1]))
            row |= tables.to_row(steps.seen(picture.key, facade, view))
            row |= tables.to_row(stood) | {"watermark": watermark}
        rows.append(row)
    return pa.Table.from_pylist(rows, RECTIFIED)


def seen_from(table: pa.Table) -> list[tuple[Seen, Standpoint, str] | Rejection]:
    """Read each facade's numbers, its camera and watermark, or its rejection."""
    return [
        (
            tables.from_row(Seen, row),
            tables.from_row(Standpoint, row),
            row[WATERMARK.name] or "",
        )
        if row["reason"] is None
        else tables.from_row(Rejection, row)
        for row in table.to_pylist()
    ]


def elevation_from(table: pa.Table, facade: int) -> Elevation:
    """Read the elevation of one facade.

    Raises:
        ValueError: if the table has none.
    """
    for row in table.to_pylist():
        if row["facade"] == facade and row["reason"] is None:
            return tables.from_row(Elevation, row)
    raise ValueError(f"no elevation of facade {facade} among {table.num_rows} rows")


@dataclass(frozen=True)
class Lent:
    """What neighbours lent to a front, in numbers."""

    photos: tuple[str, ...]  # keys
    fits: str  # of each lender, as JSON
    unseen: int
    left: int
    front: int


def borrowed_table(made: Borrowed) -> pa.Table:
    """Write a front that neighbours lent to, and where what they lent comes from."""
    marks = made.elevation.evidence
    row = tables.to_row(made.elevation) | {
        "sources": tables.to_png(made.sources),
        "photos": list(made.photos),
        "fits": json.dumps([asdict(one) for one in made.fits]),
        "unseen": made.unseen,
        "left": int(inpaint.holes(marks).sum()),
        "front": int((marks != evidence.NOTHING).sum()),
    }
    return pa.Table.from_pylist([row], BORROWED)


def lent_from(table: pa.Table) -> Lent:
    """Read what neighbours lent to a front, without its pixels."""
    row = table.to_pylist()[0]
    return Lent(tuple(row.pop("photos")), **{name: row[name] for name in LENT[1:]})


def elevations_from(table: pa.Table) -> dict[int, Elevation]:
    """Read all elevations of a photo, by facade."""
    return {
        row["facade"]: tables.from_row(Elevation, row)
        for row in table.to_pylist()
        if row["reason"] is None
    }
