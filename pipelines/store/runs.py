"""What one run knows, as tables: references and reasons, never pixels.

    CITY/runs/<run id>/{photos,facades,buildings,blocks,places,rejections}.parquet
    CITY/runs/<run id>/run.json

The run's id is a hash of what was asked for. Over a run that was shown none is written:
one that is repeated has the next id of a line, and comes back to the earlier one if its
tables are the same (`build.twin`). Clock times are in run.json and the metrics.prom
made of it alone. The table of a large archive is written in parts, as
`photos-03-of-64.parquet`, none of which is more than one process holds; what is told of
one photo or block stands in one part.
"""

import errno
import hashlib
import json
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, Final

import pyarrow as pa

from nostalgin_core.records import Rejection, Seen, Standpoint
from nostalgin_core.views import Claim
from pipelines.models import READER
from pipelines.store import tables
from pipelines.store.stable import key_of
from pipelines.store.store import Store
from pipelines.store.versions import Versions


def columns(**kinds: pa.DataType) -> pa.Schema:
    """Give a schema by names and types."""
    return pa.schema([pa.field(name, kind) for name, kind in kinds.items()])


CURRENT: Final = "CURRENT"  # the file that names the run whose city is shown
PUBLISHED: Final = "published.json"  # in a run's folder: it was shown once
REDONE: Final = "redone"  # in a run's folder: tables of a part that is at work
PASSES: Final = "passes"  # in either: those of each pass, while the run is at work
NAME: Final = re.compile(r"\w{1,64}")  # of a run
TEXT, NUMBER, COUNT = pa.string(), pa.float64(), pa.int64()
NUMBERS: Final = pa.list_(pa.float64())
Part = tuple[int, int]  # which, from 0, of how many
PART: Final = 20_000  # rows of a manifest for each part of a run's tables
BATCH: Final = 1024  # rows that are written or read as plain values at once
HEAD: Final = 256  # letters by which rows are sorted; by all if these are the same

PHOTOS: Final = columns(
    name=TEXT,
    root=TEXT,
    key=TEXT,
    sha256=TEXT,
    blocks=pa.list_(TEXT),
    outline=TEXT,  # of its front, if somebody drew it; its artifacts' keys have it
    quad=TEXT,  # the same
)
STAMPS: Final = columns(name=TEXT, root=TEXT, size=COUNT, mtime_ns=COUNT)
FACADES: Final = pa.schema(
    [
        *columns(name=TEXT, elevations=TEXT),
        *tables.schema(Seen),
        *tables.schema(Standpoint),  # of its photo's camera, in widths of the facade
        *columns(watermark=TEXT),  # what one said that was taken out of its tones
    ]
)
BUILDINGS: Final = columns(
    block=TEXT,
    building_id=TEXT,
    lot=TEXT,
    address=TEXT,
    height_m=NUMBER,
    height_low_m=NUMBER,  # of the interval that holds it in nine of ten cases
    height_high_m=NUMBER,
    height_by_storeys_m=NUMBER,  # what each witness says by itself
    height_by_width_m=NUMBER,
    height_by_list_m=NUMBER,
    height_supported=pa.bool_(),
    height_contradicted_by=pa.list_(TEXT),  # witnesses outside the interval
    footprint_m=NUMBERS,
    assumed=pa.bool_(),
    fronts=pa.list_(TEXT),
    photos=pa.list_(TEXT),  # worn, in the order of the walls
    roots=pa.list_(TEXT),
    facades=pa.list_(COUNT),
    scores=NUMBERS,
    elevations=pa.list_(TEXT),  # artifacts of the finished elevations
)
BLOCKS: Final = columns(
    block=TEXT,
    model=TEXT,  # the artifact that holds the GLB
    sha256=TEXT,
    low_m=NUMBERS,
    high_m=NUMBERS,
    coarse_sha256=TEXT,  # of the GLB with fewer texels; empty: there is none
    coarse_texel_m=NUMBER,  # its largest texel
    outlines_m=pa.list_(NUMBERS),
    closures_m=NUMBERS,  # by how much each ring, as measured, missed its start
    buildings=COUNT,
    assumed=COUNT,
    credit=TEXT,
    record=TEXT,  # what the viewer tells of it, as JSON
    compared=pa.list_(TEXT),  # the artifact of `compare`; none: nothing was compared
)
CLAIMS: Final = pa.schema([*columns(block=TEXT, name=TEXT), *tables.schema(Claim)])
BORROWED: Final = columns(
    front_id=TEXT,
    name=TEXT,  # of the photo that is worn
    facade=COUNT,
    lenders=pa.list_(TEXT),  # names of the other photos that are claimed to show it
    photos=pa.list_(TEXT),  # keys of those that lent
    unseen=NUMBER,  # share of the front that its own photo does not show
    left=NUMBER,  # that no photo shows
    fits=TEXT,  # how each lender fits, as JSON
    borrowed=pa.list_(TEXT),  # the artifact; none where nobody else shows it
)
PLACES: Final = columns(
    block=TEXT,
    how=TEXT,  # by its outline, a point, or its streets alone
    longitude_deg=NUMBER,  # of its frame's origin
    latitude_deg=NUMBER,
    bearing_deg=NUMBER,  # of its first side, block on the left hand
    east_m=NUMBER,  # in the city's plane
    north_m=NUMBER,
    turn_rad=NUMBER,
    misfit_m=NUMBER,  # from its outline, in the median
    note=TEXT,
)
REJECTIONS: Final = tables.schema(Rejection)
SCHEMAS: Final = {
    "photos": PHOTOS,
    "stamps": STAMPS,  # by which a file is known to be unchanged, without reading it
    "facades": FACADES,
    "buildings": BUILDINGS,
    "blocks": BLOCKS,
    "claims": CLAIMS,  # which front each facade of each photo shows
    "borrowed": BORROWED,  # what neighbours lent to fronts
    "places": PLACES,  # of a run that was published
    "rejections": REJECTIONS,
}
OF_WORK: Final = tuple(name for name in SCHEMAS if name != "places")  # of a pipeline


def run_id(manifest_sha256: str, versions: Versions, shard: str) -> str:
    """Name a run by what was asked for."""
    built = {stage: one for stage, one in vars(versions).items() if stage != READER}
    return key_of(manifest_sha256, json.dumps(built), shard)[:12]


def shown(store: Store) -> str:
    """Name the run whose city is shown.

    Raises:
        FileNotFoundError: if none is.
        OSError: if what should name it is damaged; its words have the remedy.
    """
    name = store.read_bytes(CURRENT).decode(errors="replace").strip()
    if NAME.fullmatch(name) is None:
        remedy = "it names no run: build again, or show one by reprocess --rollback"
        raise OSError(errno.EIO, remedy, f"{store.root}/{CURRENT}")
    return name


def was_shown(store: Store, run: str) -> bool:
    """Tell whether a run was published once."""
    return store.exists(f"runs/{run}/{PUBLISHED}")


def parts_of(rows: int) -> int:
    """Tell in how many parts the tables of a run over so many rows are written.

    It is a power of two, so that a part follows from one part of a table that has half
    as many, or twice (`sources`).
    """
    return 1 << (rows // PART).bit_length()


def sources(which: Part, there: int) -> list[int]:
    """List the parts of a table of so many that rows of this part may stand in.

    A row stands in the part that is the remainder of one number, so that both parts
    are alike by the greatest common divisor of both counts.
    """
    part, parts = which
    common = math.gcd(parts, there)
    return list(range(part % common, there, common)) if there else []


def table_path(run: str, name: str, which: Part = (0, 1)) -> str:
    """Name a run's table, or one of its parts, relative to the city folder."""
    part, parts = which
    told = "" if parts == 1 else f"-{part + 1:02}-of-{parts:02}"
    return f"runs/{run}/{name}{told}.parquet"


def part_of(name: str, row: dict[str, Any], parts: int) -> int:
    """Tell which part a row stands in: it follows from its first column."""
    told = str(row[SCHEMAS[name].names[0]]).encode(errors="surrogateescape")
    return int.from_bytes(hashlib.sha256(told).digest()[:8], "big") % parts


def write_table(
    store: Store,
    run: str,
    name: str,
    rows: Iterable[dict[str, Any]],
    which: Part = (0, 1),
) -> None:
    """Write a run's table, sorted, so that no order of the workers shows."""
    table = pa.Table.from_pylist(list(rows), SCHEMAS[name])
    write_sorted(store, run, name, table, which)


def write_sorted(
    store: Store, run: str, name: str, table: pa.Table, which: Part = (0, 1)
) -> None:
    """Write a run's table as `write_table` does, of rows that are a table already."""
    # one name, so that no copy outlives the next
    table = table.cast(SCHEMAS[name]).replace_schema_metadata(None).combine_chunks()
    keys = [text[:HEAD] for text in texts(table)]
    if len(set(keys)) < len(keys):
        keys = list(texts(table))
    order = sorted(range(table.num_rows), key=keys.__getitem__)
    table = table.take(pa.array(order, pa.int64())).combine_chunks()
    store.write_table(table_path(run, name, which), table)


def texts(table: pa.Table) -> Iterator[str]:
    """Write each row as text, by which rows are sorted, a few at a time."""
    for batch in table.to_batches(max_chunksize=BATCH):
        for row in batch.to_pylist():
            yield json.dumps(row, sort_keys=True)


def part_names(store: Store, run: str, name: str) -> list[str]:
    """Name the files of a run's table."""
    ours = re.compile(rf"{name}(-\d+-of-\d+)?\.parquet")
    return [one for one in store.names(f"runs/{run}") if ours.fullmatch(one)]


def each_part(
    store: Store, run: str, name: str, columns: Sequence[str] | None = None
) -> Iterator[pa.Table]:
    """Read a run's table part by part, or some of its columns.

    Raises:
        FileNotFoundError: if there is none.
        Damaged: if a part is not what was written.
    """
    for one in part_names(store, run, name) or [f"{name}.parquet"]:
        yield store.read_table(f"runs/{run}/{one}", columns)


def read_rows(store: Store, run: str, name: str) -> Iterator[dict[str, Any]]:
    """Read a run's table row by row, holding one part."""
    for table in each_part(store, run, name):
        for batch in table.to_batches(max_chunksize=BATCH):
            yield from batch.to_pylist()


def read_table(store: Store, run: str, name: str) -> list[dict[str, Any]]:
    """Read a run's table."""
    return list(read_rows(store, run, name))


def read_column(store: Store, run: str, name: str, column: str) -> list[Any]:
    """Read one column of a run's table: of a large archive, all is too much."""
    parts = each_part(store, run, name, [column])
    return [cell for table in parts for cell in table.column(column).to_pylist()]
