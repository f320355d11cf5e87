"""From facades to blocks: who shows which front, then one model a block."""

import hashlib
import json
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Final

import apache_beam as beam
import pyarrow as pa
from apache_beam import pvalue

from nostalgin_core import assign, atlas, block, gltf, mesh, picture
from nostalgin_core.records import Assignment, Block, Building, Elevation, Rejection
from pipelines import tables
from pipelines.attempt import Attempt, Outcome
from pipelines.plan import BlockTask
from pipelines.stages import Bench, FacadeRef, Work

MODEL: Final = pa.schema(
    [
        pa.field("block", pa.string()),
        pa.field("glb", pa.binary()),
        pa.field("sha256", pa.string()),
        pa.field("low_m", pa.list_(pa.float64())),
        pa.field("high_m", pa.list_(pa.float64())),
    ]
)


@dataclass(frozen=True)
class Placed:
    """A block whose facades are assigned and whose cuboids stand."""

    task: BlockTask
    facades: tuple[FacadeRef, ...]  # all that were seen, ordered
    assignments: tuple[Assignment, ...]
    block: Block

    @property
    def key(self) -> str:
        """Name the block in rejections."""
        return self.task.block

    def worn(self) -> tuple[FacadeRef, ...]:
        """List the facades that a wall wears: only these need inpainting."""
        textures = {
            wall.texture
            for building in self.block.buildings
            for wall in building.walls
            if wall.texture is not None
        }
        unique = {texture_of(ref): ref for ref in reversed(self.facades)}
        return tuple(unique[texture] for texture in sorted(textures))


@dataclass(frozen=True)
class Modelled:
    """A block whose model is in the store."""

    placed: Placed
    path: str  # of the artifact
    sha256: str  # of the GLB
    low_m: tuple[float, float, float]  # east, north, up
    high_m: tuple[float, float, float]

    @property
    def key(self) -> str:
        """Name the block in rejections."""
        return self.placed.key


def texture_of(ref: FacadeRef) -> tuple[str, int]:
    """Name a facade as walls do."""
    return ref.seen.photo, ref.seen.facade


@dataclass
class Assign(beam.PTransform):
    """Blocks grouped with their facades in; blocks with cuboids out."""

    def expand(self, grouped: pvalue.PCollection) -> Outcome:
        """Wire the stage."""
        return grouped | Attempt(placed, stage="assign")


@dataclass
class Model(beam.PTransform):
    """Blocks grouped with their finished facades in; blocks with models out."""

    bench: Bench

    def expand(self, grouped: pvalue.PCollection) -> Outcome:
        """Wire the stage."""
        return grouped | Attempt(Work(modelled, self.bench), stage="block")


def placed(grouped: tuple[str, dict[str, Iterable[Any]]]) -> list[Placed | Rejection]:
    """Give facades to the fronts of a block, and raise its buildings."""
    _, parts = grouped
    (task,) = parts["task"]
    facades = tuple(sorted(parts["facades"], key=order))
    outcomes = assigned(task, facades)
    assignments = tuple(one for one in outcomes if isinstance(one, Assignment))
    rejections = [one for one in outcomes if isinstance(one, Rejection)]
    return [stood(task, facades, assignments), *rejections]


def stood(
    task: BlockTask,
    facades: tuple[FacadeRef, ...],
    assignments: tuple[Assignment, ...],
) -> Placed:
    """Raise the buildings of a block."""
    aspects = {texture_of(r): (r.seen.aspect, r.seen.aspect_sd) for r in facades}
    built = block.block(task.block, task.fronts, assignments, aspects)
    return Placed(task, facades, assignments, built)


def order(ref: FacadeRef) -> tuple[str, str, int]:
    """Put facades into an order that no worker can change."""
    return ref.photo.name, ref.photo.root, ref.seen.facade


def modelled(
    grouped: tuple[str, dict[str, Iterable[Any]]], bench: Bench
) -> Modelled | Rejection:
    """Keep a block's GLB."""
    _, parts = grouped
    (one,) = parts["placed"]
    one = only(one, {texture_of(ref) for ref in parts["finished"]})
    key = bench.versions.key("block", *contents(one, bench))
    path = bench.versions.path("block", key)
    bench.keep(path, lambda: model(one, bench))
    row = bench.store.read_table(path, ["sha256", "low_m", "high_m"]).to_pylist()[0]
    return Modelled(one, path, row["sha256"], tuple(row["low_m"]), tuple(row["high_m"]))


def only(one: Placed, done: set[tuple[str, int]]) -> Placed:
    """Raise the buildings anew if a facade they wear could not be finished."""
    if all(texture_of(ref) in done for ref in one.worn()):
        return one
    kept = tuple(a for a in one.assignments if (a.photo, a.facade) in done)
    return stood(one.task, one.facades, kept)


def contents(one: Placed, bench: Bench) -> list[str]:
    """List what a block's model is made from: its buildings, names and elevations."""
    buildings = [
        [b.building_id, b.footprint_m.tolist(), b.height_m, b.assumed, walls(b)]
        for b in one.block.buildings
    ]
    finished = [
        bench.versions.inpaint_key(ref.photo.sha256, ref.seen.facade)
        for ref in one.worn()
    ]
    return [json.dumps([one.key, one.task.credit, buildings, columns(one)]), *finished]


def walls(building: Building) -> list[dict[str, Any]]:
    """Write a building's walls as plain values."""
    return [tables.to_row(wall) for wall in building.walls]


def columns(one: Placed) -> dict[str, list[str]]:
    """Write what a click on a building tells, a row a building."""
    fronts: dict[str, list[Any]] = {}
    for front in one.task.fronts:
        fronts.setdefault(f"{front.block}-{front.lot}", []).append(front)
    rows = [fronts.get(b.building_id, []) for b in one.block.buildings]
    return {
        "id": [b.building_id for b in one.block.buildings],
        "lot": [own[0].lot if own else "" for own in rows],
        "address": ["; ".join(address(front) for front in own) for own in rows],
        "assumed": ["yes" if b.assumed else "no" for b in one.block.buildings],
    }


def address(front: Any) -> str:
    """Write a front's address in one line."""
    return f"{front.address} {front.street}".strip()


def model(one: Placed, bench: Bench) -> pa.Table:
    """Make a block's GLB from its cuboids and its finished elevations."""
    views = {texture_of(ref): finished(ref, bench) for ref in one.worn()}
    pages = atlas.build(
        {
            (*wall.texture, wall.evidence): views[wall.texture]
            for building in one.block.buildings
            for wall in building.walls
            if wall.texture is not None
        }
    )
    meshes = [
        (building.building_id, mesh.building(building, pages, number=number))
        for number, building in enumerate(one.block.buildings)
    ]
    data = gltf.glb(
        one.key,
        meshes,
        colours=picture.colours(pages),
        evidence=picture.evidence_key(pages),
        table=columns(one),
        copyright=one.task.credit,
    )
    whole = mesh.joined([each for _, each in meshes])
    row = {
        "block": one.key,
        "glb": data,
        "sha256": hashlib.sha256(data).hexdigest(),
        "low_m": whole.positions_m.min(axis=0).tolist(),
        "high_m": whole.positions_m.max(axis=0).tolist(),
    }
    return pa.Table.from_pylist([row], MODEL)


def finished(ref: FacadeRef, bench: Bench) -> Elevation:
    """Read a facade's finished elevation."""
    key = bench.versions.inpaint_key(ref.photo.sha256, ref.seen.facade)
    rows = bench.store.read_table(bench.versions.path("inpaint", key))
    return tables.records(Elevation, rows)[0]
