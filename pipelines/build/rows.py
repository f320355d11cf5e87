"""What a run has done becomes rows, and the rows of all workers become its tables."""

import json
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import apache_beam as beam
from apache_beam import pvalue

from nostalgin_core import model
from nostalgin_core.records import Height, Rejection
from pipelines import site
from pipelines.build.blocks import Modelled, Placed, texture_of
from pipelines.build.stages import FacadeRef
from pipelines.index.plan import PhotoRef
from pipelines.store import Store, runs, tables
from pipelines.store.versions import Versions

Rows = Iterable[dict[str, Any]]


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
        known = tables.to_row(ref.seen) | tables.to_row(ref.standpoint)
        return [{"name": ref.photo.name, "elevations": where} | known]


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
                "address": model.address(own),
                "height_m": building.height_m,
                **known(building.height),
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


def known(height: Height | None) -> dict[str, Any]:
    """Tell how a height is known, if it is."""
    if height is None:
        return {"height_supported": False}
    return {
        "height_low_m": height.low_m,
        "height_high_m": height.high_m,
        "height_by_storeys_m": height.by_storeys_m,
        "height_by_width_m": height.by_width_m,
        "height_by_list_m": height.by_list_m,
        "height_supported": height.supported,
        "height_contradicted_by": list(height.contradicting),
    }


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
            "coarse_sha256": done.coarse_sha256,
            "coarse_texel_m": done.coarse_texel_m,
            "outlines_m": [outline.ravel().tolist() for outline in built.outline_m],
            "closures_m": list(built.closure_m),
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
    known = site.record(
        one.block,
        fronts=one.settled.fronts,
        assignments=one.settled.assignments,
        seen=[ref.seen for ref in one.facades],
        stood={texture_of(ref): ref.standpoint for ref in one.facades},
        photos=told,
    )
    return json.dumps(known, sort_keys=True)


def rejection_rows(one: Rejection) -> Rows:
    """Tell why something went no further."""
    return [tables.to_row(one)]


@dataclass
class WriteTable(beam.PTransform):
    """Elements in, sorted tables out, whatever order the workers took."""

    store: Store
    run: str
    name: str
    rows: Callable[[Any], Rows]
    parts: int = 1

    def expand(self, elements: pvalue.PCollection) -> Any:
        """Wire rows to files; each is written even if it has none."""
        every = elements.pipeline | "Parts" >> beam.Create(
            [(part, []) for part in range(self.parts)], reshuffle=False
        )
        told = elements | "Rows" >> beam.FlatMap(self._told)
        return (
            (told, every)
            | beam.Flatten()
            | "Gather" >> beam.GroupByKey()
            | "Write" >> beam.MapTuple(self._write)
        )

    def _told(self, element: Any) -> Iterator[tuple[int, Rows]]:
        for row in self.rows(element):
            yield runs.part_of(self.name, row, self.parts), [row]

    def _write(self, part: int, told: Iterable[Rows]) -> str:
        rows = [row for one in told for row in one]
        which = (part, self.parts)
        runs.write_table(self.store, self.run, self.name, rows, which)
        return self.name
