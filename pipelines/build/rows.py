"""What a run has done becomes rows, and the rows of all workers become its tables."""

import json
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import apache_beam as beam
from apache_beam import pvalue

from nostalgin_core import model
from nostalgin_core.records import Height, Rejection, Texture
from pipelines import site, stopping
from pipelines.build.blocks import Modelled, Placed, texture_of
from pipelines.build.stages import FacadeRef
from pipelines.build.worn import Worn
from pipelines.index.plan import PhotoRef
from pipelines.store import Store, runs, tables
from pipelines.store.versions import Versions

Rows = Iterable[dict[str, Any]]


def photo_rows(ref: PhotoRef) -> Rows:
    """Tell which file a photo was."""
    told = {"name": ref.name, "root": ref.root, "sha256": ref.sha256}
    told |= {"outline": ref.outline, "quad": ref.quad}
    return [told | {"key": ref.sha256[:16], "blocks": list(ref.blocks)}]


def stamp_rows(ref: PhotoRef) -> Rows:
    """Tell how large a photo's file was, and when it was changed."""
    told = {"name": ref.name, "root": ref.root}
    return [told | {"size": ref.size, "mtime_ns": ref.mtime_ns}]


@dataclass(frozen=True)
class FacadeRows:
    """Tell what is known of a facade, and where its elevation lies."""

    versions: Versions

    def __call__(self, ref: FacadeRef) -> Rows:
        """Write one row."""
        key = self.versions.rectify_key(ref.photo.sha256, *ref.photo.drawn)
        where = self.versions.path("rectify", key)
        known = tables.to_row(ref.seen) | tables.to_row(ref.standpoint)
        named = {"name": ref.photo.name, "elevations": where}
        return [named | known | {"watermark": ref.watermark}]


@dataclass(frozen=True)
class BuildingRows:
    """Tell where buildings stand and what they wear."""

    versions: Versions

    def __call__(self, done: Modelled) -> Rows:
        """Write a row a building."""
        one = done.placed
        refs = {texture_of(ref): ref for ref in one.facades}
        scores = {(a.photo, a.facade): a.score for a in one.settled.assignments}
        paths = self._paths(one)
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
                "elevations": [paths[texture] for texture in worn],
            }

    def _paths(self, one: Placed) -> dict[Texture, str]:
        return {
            texture_of(each.own): self.versions.path(
                "inpaint", each.inpaint_key(self.versions)
            )
            for each in one.worn()
        }


@dataclass(frozen=True)
class BorrowedRows:
    """Tell what other photographs lent to a front."""

    versions: Versions

    def __call__(self, one: Worn) -> Rows:
        """Write one row."""
        lent, unseen = one.lent, 1 - one.own.seen.photographed
        whole = max(lent.front, 1) if lent else 1
        key = one.borrow_key(self.versions)
        return [
            {
                "front_id": one.front_id,
                "name": one.own.photo.name,
                "facade": one.own.seen.facade,
                "lenders": [each.photo.name for each in one.lenders],
                "photos": list(lent.photos) if lent else [],
                "unseen": lent.unseen / whole if lent else unseen,
                "left": lent.left / whole if lent else unseen,
                "fits": lent.fits if lent else "[]",
                "borrowed": [self.versions.path("borrow", key)] if lent else [],
            }
        ]


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
            "compared": [done.placed.compared] if done.placed.compared else [],
        }
    ]


def record(one: Placed) -> str:
    """Write what the viewer tells of a block."""
    told = {
        ref.seen.photo: {
            "credit": site.credited(one.task.credit, ref.watermark),
            "caption": ref.photo.name,
            **({"watermark": ref.watermark} if ref.watermark else {}),
        }
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


def claim_rows(one: Placed) -> Rows:
    """Tell which front each facade of a block's photographs shows."""
    names = {ref.seen.photo: ref.photo.name for ref in reversed(one.facades)}
    return [
        {"block": one.key, "name": names[claim.photo], **tables.to_row(claim)}
        for claim in one.settled.claims
    ]


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
        if stopping.asked():  # some may lack
            return self.name
        rows = [row for one in told for row in one]
        which = (part, self.parts)
        runs.write_table(self.store, self.run, self.name, rows, which)
        return self.name
