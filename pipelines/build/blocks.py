"""From facades to blocks: who shows which front, then one model a block."""

import hashlib
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from typing import Any, Final

import apache_beam as beam
import pyarrow as pa
from apache_beam import pvalue

from nostalgin_core import block, model, views
from nostalgin_core.block import Settled
from nostalgin_core.records import (
    Block,
    Building,
    Elevation,
    Rejection,
    Seen,
    Texture,
)
from pipelines.build import compare
from pipelines.build.bench import Bench
from pipelines.build.stages import FacadeRef, named
from pipelines.build.worn import Worn, inpainted
from pipelines.index.plan import BlockTask, Name
from pipelines.store import tables

MODEL: Final = pa.schema(
    [
        pa.field("block", pa.string()),
        pa.field("glb", pa.binary()),
        pa.field("sha256", pa.string()),
        pa.field("low_m", pa.list_(pa.float64())),
        pa.field("high_m", pa.list_(pa.float64())),
        pa.field("coarse", pa.binary()),  # the same with fewer texels; may be empty
        pa.field("coarse_sha256", pa.string()),
        pa.field("coarse_texel_m", pa.float64()),
    ]
)


@dataclass(frozen=True)
class Placed:
    """A block whose facades are assigned and whose cuboids stand."""

    task: BlockTask
    facades: tuple[FacadeRef, ...]  # all that were seen, ordered
    settled: Settled
    compared: str  # the artifact that tells which facades look alike; "": there is none

    @property
    def key(self) -> str:
        """Name the block in rejections."""
        return self.task.block

    @property
    def block(self) -> Block:
        """The cuboids."""
        return self.settled.block

    def worn(self) -> tuple[Worn, ...]:
        """List the facades that a wall wears, and who else shows their fronts."""
        of = {texture_of(ref): ref for ref in reversed(self.facades)}
        return tuple(
            Worn(of[one.texture], one.front_id, tuple(of[o] for o in one.lenders))
            for one in self.settled.shown()
        )


@dataclass(frozen=True)
class Modelled:
    """A block whose model is in the store."""

    placed: Placed
    path: str  # of the artifact
    sha256: str  # of the GLB
    low_m: tuple[float, float, float]  # east, north, up
    high_m: tuple[float, float, float]
    coarse_sha256: str  # of the GLB for those far away; empty: there is none
    coarse_texel_m: float  # its largest texel

    @property
    def key(self) -> str:
        """Name the block in rejections."""
        return self.placed.key


def texture_of(ref: FacadeRef) -> Texture:
    """Name a facade as walls do."""
    return ref.seen.photo, ref.seen.facade


@dataclass
class Assign(beam.PTransform):
    """Blocks grouped with their facades in; blocks with cuboids out."""

    bench: Bench

    def expand(self, grouped: pvalue.PCollection) -> Any:
        """Wire the stage."""
        return grouped | self.bench.attempt(placed, "assign")


@dataclass
class Model(beam.PTransform):
    """Blocks grouped with their finished facades in; blocks with models out."""

    bench: Bench

    def expand(self, grouped: pvalue.PCollection) -> Any:
        """Wire the stage."""
        return grouped | self.bench.attempt(modelled, "block")


def placed(
    grouped: tuple[str, dict[str, Iterable[Any]]], bench: Bench
) -> list[Placed | Rejection]:
    """Give facades to the fronts of a block, and raise its buildings.

    Which facades look alike is kept; all else is numbers.
    """
    _, parts = grouped
    (task,) = parts["task"]
    facades = meant(sorted(parts["facades"], key=order), dict(task.targets_px))
    names = {ref.seen.photo: ref.photo.name for ref in reversed(facades)}
    keys = {(ref.photo.root, ref.photo.name): ref.seen.photo for ref in facades}
    candidates: dict[str, list[str]] = {}
    for photo, front_id in task.photos:
        if photo in keys:
            candidates.setdefault(keys[photo], []).append(front_id)
    # Of one content under two names the first counts, as it does where it is worn.
    first: dict[Texture, Seen] = {}
    for ref in facades:
        first.setdefault(texture_of(ref), ref.seen)
    seen = tuple(first.values())
    known = told(task)
    stood = list({texture_of(ref): ref for ref in reversed(facades)}.values())[::-1]
    stretches = [views.stretch(ref.seen, ref.standpoint) for ref in stood]
    looks = compare.compared(task.fronts, candidates, stood, bench)
    settled = block.settle(
        task.block,
        task.fronts,
        candidates,
        seen,
        stretches=stretches,
        alike=looks.alike,
        **known,
    )
    rejections = [named(one, names[one.key]) for one in settled.rejections]
    return [Placed(task, facades, settled, looks.path), *rejections]


def told(task: BlockTask) -> dict[str, dict[str, float]]:
    """Give what is known of a block beside its rows."""
    return {"heights_m": dict(task.heights_m), "widths_m": dict(task.widths_m)}


def meant(
    facades: Sequence[FacadeRef], targets_px: Mapping[Name, float]
) -> tuple[FacadeRef, ...]:
    """Make the facade nearest to a given x the one that its photo is a record of."""
    nearest: dict[Name, FacadeRef] = {}
    for ref in facades:
        name = (ref.photo.root, ref.photo.name)
        if name in targets_px:
            x = targets_px[name]
            best = nearest.setdefault(name, ref)
            if abs(ref.seen.left_px - x) < abs(best.seen.left_px - x):
                nearest[name] = ref

    def directed(ref: FacadeRef) -> FacadeRef:
        best = nearest.get((ref.photo.root, ref.photo.name))
        if best is None:
            return ref
        target = ref.seen.facade == best.seen.facade
        seen = replace(ref.seen, target=target, target_score=float(target))
        return replace(ref, seen=seen)

    return tuple(map(directed, facades))


def order(ref: FacadeRef) -> tuple[str, str, int]:
    """Put facades into an order that no worker can change."""
    return ref.photo.name, ref.photo.root, ref.seen.facade


def modelled(
    grouped: tuple[str, dict[str, Iterable[Any]]], bench: Bench
) -> Modelled | Rejection:
    """Keep a block's GLB."""
    _, parts = grouped
    (one,) = parts["placed"]
    one = only(one, {texture_of(one.own) for one in parts["finished"]})
    key = bench.versions.key("block", *contents(one, bench))
    path = bench.versions.path("block", key)
    make = partial(bench.keep, path, partial(glb, one, bench))
    make()
    told = ["sha256", "low_m", "high_m", "coarse_sha256", "coarse_texel_m"]
    row = bench.read(path, make, told).to_pylist()[0]
    bounds = {name: tuple(row.pop(name)) for name in ("low_m", "high_m")}
    return Modelled(one, path, **bounds, **row)


def only(one: Placed, done: set[Texture]) -> Placed:
    """Raise the buildings anew if a facade they wear could not be finished."""
    if all(texture in done for texture in one.settled.worn()):
        return one
    before = one.settled
    kept = tuple(a for a in before.assignments if (a.photo, a.facade) in done)
    seen = tuple(ref.seen for ref in one.facades)
    anew = block.raised(one.key, before.fronts, kept, seen, **told(one.task))
    return replace(one, settled=replace(before, assignments=kept, block=anew))


def contents(one: Placed, bench: Bench) -> list[str]:
    """List what a block's model is made from: its buildings, names and elevations."""
    buildings = [
        [b.building_id, b.footprint_m.tolist(), b.height_m, b.assumed, walls(b)]
        for b in one.block.buildings
    ]
    finished = [each.inpaint_key(bench.versions) for each in one.worn()]
    return [
        json.dumps([one.key, one.task.credit, buildings, model.table(one.settled)]),
        json.dumps([bench.image_format, asdict(rights(one))]),
        *finished,
    ]


def rights(one: Placed) -> model.Rights:
    """Tell whose the photographs are that a block's walls wear."""
    task, told = one.task, dict(one.task.told)
    refs = [ref for each in one.worn() for ref in (each.own, *each.lenders)]
    photos = {ref.seen.photo: ref.photo for ref in refs}
    names = {key: (ref.root, ref.name) for key, ref in sorted(photos.items())}
    worn = {key: dict(told[name]) for key, name in names.items() if name in told}
    marks = tuple(sorted({ref.watermark for ref in refs} - {""}))
    return model.Rights(task.credit, task.licence, task.sources, worn, marks)


def walls(building: Building) -> list[dict[str, Any]]:
    """Write a building's walls as plain values."""
    return [tables.to_row(wall) for wall in building.walls]


def glb(one: Placed, bench: Bench) -> pa.Table:
    """Make a block's GLB from its cuboids and its finished elevations."""
    views = {texture_of(each.own): finished(each, bench) for each in one.worn()}
    made = model.model(
        one.settled, views, rights=rights(one), image_format=bench.image_format
    )
    row = {
        "block": one.key,
        "glb": made.glb,
        "sha256": hashlib.sha256(made.glb).hexdigest(),
        "low_m": made.mesh.positions_m.min(axis=0).tolist(),
        "high_m": made.mesh.positions_m.max(axis=0).tolist(),
        "coarse": made.coarse,
        "coarse_sha256": hashlib.sha256(made.coarse).hexdigest() if made.coarse else "",
        "coarse_texel_m": made.coarse_texel_m,
    }
    return pa.Table.from_pylist([row], MODEL)


def finished(one: Worn, bench: Bench) -> Elevation:
    """Read a facade's finished elevation."""
    again = partial(inpainted, one, bench, bench.network("inpaint"))
    path = bench.versions.path("inpaint", one.inpaint_key(bench.versions))
    return tables.records(Elevation, bench.read(path, again))[0]
