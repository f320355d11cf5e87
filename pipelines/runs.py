"""What one run knows, as tables: references and reasons, never pixels.

    CITY/runs/<run id>/{photos,facades,buildings,blocks,rejections}.parquet, run.json

The run's id is a hash of what was asked for, so a run that is repeated writes the same
tables to the same place. Clock times are in run.json alone.
"""

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Final

import apache_beam as beam
import pyarrow as pa
from apache_beam import pvalue

from nostalgin_core import facts
from nostalgin_core.records import Rejection, Seen
from pipelines import site_record, tables
from pipelines.blocks import Modelled, Placed, texture_of
from pipelines.stages import FacadeRef, PhotoRef
from pipelines.store import Store, key_of
from pipelines.versions import Versions

Rows = Iterable[dict[str, Any]]


def columns(**kinds: pa.DataType) -> pa.Schema:
    """Give a schema by names and types."""
    return pa.schema([pa.field(name, kind) for name, kind in kinds.items()])


TEXT, NUMBER, COUNT = pa.string(), pa.float64(), pa.int64()
NUMBERS: Final = pa.list_(pa.float64())

PHOTOS: Final = columns(
    name=TEXT, root=TEXT, key=TEXT, sha256=TEXT, blocks=pa.list_(TEXT)
)
FACADES: Final = pa.schema([*columns(name=TEXT, elevations=TEXT), *tables.schema(Seen)])
BUILDINGS: Final = columns(
    block=TEXT,
    building_id=TEXT,
    lot=TEXT,
    address=TEXT,
    height_m=NUMBER,
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
    outlines_m=pa.list_(NUMBERS),
    buildings=COUNT,
    assumed=COUNT,
    credit=TEXT,
    record=TEXT,  # what the viewer tells of it, as JSON
)
REJECTIONS: Final = tables.schema(Rejection)
SCHEMAS: Final = {
    "photos": PHOTOS,
    "facades": FACADES,
    "buildings": BUILDINGS,
    "blocks": BLOCKS,
    "rejections": REJECTIONS,
}


def run_id(manifest_sha256: str, versions: Versions, shard: str) -> str:
    """Name a run by what was asked for."""
    return key_of(manifest_sha256, json.dumps(vars(versions)), shard)[:12]


def photo_rows(ref: PhotoRef) -> Rows:
    """Tell which file a photo was."""
    row = vars(ref) | {"key": ref.sha256[:16], "blocks": list(ref.blocks)}
    return [row]


@dataclass(frozen=True)
class FacadeRows:
    """Tell what is known of a facade, and where its elevation lies."""

    versions: Versions

    def __call__(self, ref: FacadeRef) -> Rows:
        """Write one row."""
        key = self.versions.rectify_key(ref.photo.sha256)
        where = self.versions.path("rectify", key)
        return [{"name": ref.photo.name, "elevations": where} | tables.to_row(ref.seen)]


@dataclass(frozen=True)
class BuildingRows:
    """Tell where buildings stand and what they wear."""

    versions: Versions

    def __call__(self, done: Modelled) -> Rows:
        """Write a row a building."""
        one = done.placed
        refs = {texture_of(ref): ref for ref in one.facades}
        scores = {(a.photo, a.facade): a.score for a in one.settled.assignments}
        for building in one.block.buildings:
            own = one.settled.fronts_of(building.building_id)
            worn = [w.texture for w in building.walls if w.texture is not None]
            worn = list(dict.fromkeys(worn))
            yield {
                "block": one.key,
                "building_id": building.building_id,
                "lot": own[0].lot if own else "",
                "address": facts.address(own),
                "height_m": building.height_m,
                "footprint_m": building.footprint_m.ravel().tolist(),
                "assumed": building.assumed,
                "fronts": [front.front_id for front in own],
                "photos": [refs[texture].photo.name for texture in worn],
                "roots": [refs[texture].photo.root for texture in worn],
                "facades": [facade for _, facade in worn],
                "scores": [scores[texture] for texture in worn],
                "elevations": [self._path(refs[texture]) for texture in worn],
            }

    def _path(self, ref: FacadeRef) -> str:
        key = self.versions.inpaint_key(ref.photo.sha256, ref.seen.facade)
        return self.versions.path("inpaint", key)


def block_rows(done: Modelled) -> Rows:
    """Tell where a block's model lies and how far it reaches."""
    built = done.placed.block
    return [
        {
            "block": done.key,
            "model": done.path,
            "sha256": done.sha256,
            "low_m": list(done.low_m),
            "high_m": list(done.high_m),
            "outlines_m": [outline.ravel().tolist() for outline in built.outline_m],
            "buildings": len(built.buildings),
            "assumed": sum(building.assumed for building in built.buildings),
            "credit": done.placed.task.credit,
            "record": record(done.placed),
        }
    ]


def record(one: Placed) -> str:
    """Write what the viewer tells of a block."""
    told = {
        ref.seen.photo: {"credit": one.task.credit, "caption": ref.photo.name}
        for ref in one.facades
    }
    known = site_record.record(
        one.block,
        fronts=one.settled.fronts,
        assignments=one.settled.assignments,
        seen=[ref.seen for ref in one.facades],
        photos=told,
    )
    return json.dumps(known, sort_keys=True)


def rejection_rows(one: Rejection) -> Rows:
    """Tell why something went no further."""
    return [tables.to_row(one)]


@dataclass
class WriteTable(beam.PTransform):
    """Elements in, one sorted table out, whatever order the workers took."""

    store: Store
    run: str
    name: str
    rows: Callable[[Any], Rows]

    def expand(self, elements: pvalue.PCollection) -> Any:
        """Wire rows to one file; it is written even if there are none."""
        return (
            elements
            | "Rows" >> beam.FlatMap(self.rows)
            | "Gather" >> beam.CombineGlobally(beam.combiners.ToListCombineFn())
            | "Write" >> beam.Map(self._write)
        )

    def _write(self, rows: list[dict[str, Any]]) -> str:
        ordered = sorted(rows, key=lambda row: json.dumps(row, sort_keys=True))
        table = pa.Table.from_pylist(ordered, SCHEMAS[self.name])
        self.store.write_table(table_path(self.run, self.name), table)
        return self.name


def table_path(run: str, name: str) -> str:
    """Name a run's table, relative to the city folder."""
    return f"runs/{run}/{name}.parquet"


def read_table(store: Store, run: str, name: str) -> list[dict[str, Any]]:
    """Read a run's table."""
    return store.read_table(table_path(run, name)).to_pylist()


def read_column(store: Store, run: str, name: str, column: str) -> list[Any]:
    """Read one column of a run's table: of a large archive, all is too much."""
    table = store.read_table(table_path(run, name), [column])
    return table.column(column).to_pylist()
