"""The boards of photographs, looked at by a pipeline that fills the city's own store.

    pieces--names --Reshuffle--Read--Placard--> readings/heard-00.parquet ...

The graph names pieces of a table, and no photograph; the tables are dropped at the end.

`index` asks for it before there is a manifest. What the network finds in a photo is
kept where `build` looks for it, so that nothing is segmented twice; what was read of a
board is an artifact too, whatever list it is joined with.
"""

import hashlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import apache_beam as beam
import cv2
import pyarrow as pa
from apache_beam import pvalue
from apache_beam.options.pipeline_options import PipelineOptions

from nostalgin_core import placard
from nostalgin_core.records import Instance, Rejection
from pipelines import stopping
from pipelines.build.bench import Bench
from pipelines.build.embedded import in_process
from pipelines.build.isolation import POOL
from pipelines.build.launched import launched
from pipelines.build.options import CityOptions
from pipelines.build.prepared import bench_of
from pipelines.build.report import Lost
from pipelines.build.stages import Read, needed, segmented, unless
from pipelines.index import Heard
from pipelines.index.asked import GROUP, Asked, Piece, grouped, short
from pipelines.index.plan import PhotoRef
from pipelines.models import READER, Once, one_thread
from pipelines.store import Damaged, Store, runs, tables

WANTED: Final = "readings/wanted.parquet"  # names
HEARD: Final = "readings/heard-{:02}.parquet"  # a part of what came of them
TEXT = pa.string()
NAME: Final = pa.schema([pa.field("name", TEXT)])
ARTIFACT: Final = pa.schema(
    [
        pa.field("found", TEXT),  # how the board was found
        pa.field("box", pa.list_(pa.int64())),
        pa.field("looks", pa.list_(pa.list_(pa.list_(TEXT)))),  # looks, lines, pieces
        pa.field("crop", pa.binary()),  # PNG
    ]
)
TOLD: Final = pa.schema(
    [pa.field(name, TEXT) for name in ("name", "sha256", "reason", "detail")]
)


@dataclass
class Placard(beam.PTransform):
    """Photos in; photos out whose boards were looked at."""

    bench: Bench

    def expand(self, photos: pvalue.PCollection) -> Any:
        """Wire the stage."""
        tools = self.bench.network("segment"), self.bench.network(READER)
        return photos | self.bench.attempt(sighted, READER, *tools)


def sighted(
    ref: PhotoRef, bench: Bench, network: Once, reader: Once
) -> PhotoRef | Rejection:
    """Keep what is read of a photo's board; one without facades may have a board."""
    versions = bench.versions

    def make() -> pa.Table | Rejection:
        picture = bench.decoded(ref)
        if isinstance(picture, Rejection):
            return picture
        path = versions.path("segment", versions.segment_key(ref.sha256))
        again = partial(segmented, ref, bench, network)
        found: list[Instance] = []
        if not isinstance(again(), Rejection):
            found = tables.records(Instance, bench.read(path, again))
        sight = placard.looked(needed(picture), placard.board(found), reader)
        return table(sight, placard.crop(picture, sight.box))

    return unless(bench.keep(path_of(ref.sha256, bench), make), ref)


def path_of(sha256: str, bench: Bench) -> str:
    """Name the artifact of a photo's board."""
    return bench.versions.path(READER, bench.versions.placard_key(sha256))


def table(sight: placard.Sight, crop: Any) -> pa.Table:
    """Write what is seen of a board, and its picture."""
    png = cv2.imencode(".png", crop)[1].tobytes() if crop.size else b""
    looks = [[list(line) for line in look.lines] for look in sight.looks]
    row = {
        "found": sight.found,
        "box": list(sight.box or ()),
        "looks": looks,
        "crop": png,
    }
    return pa.Table.from_pylist([row], ARTIFACT)


def told(one: PhotoRef | Rejection) -> dict[str, str]:
    """Tell what came of a photo."""
    if isinstance(one, Rejection):
        why = {"reason": one.reason, "detail": one.detail}
        return {"name": one.key, "sha256": ""} | why
    return {"name": one.name, "sha256": one.sha256, "reason": "", "detail": ""}


@dataclass(frozen=True)
class Wire:
    """The pipeline over some photographs of a folder, whose names the store has."""

    bench: Bench
    root: str
    pieces: Sequence[Piece]  # of the names
    parts: int  # of what is told

    def __call__(self, pipeline: beam.Pipeline) -> None:
        """Wire the whole way from names to what was heard."""
        photos = (
            pipeline
            | "Pieces" >> beam.Create(self.pieces)
            | "Photos" >> beam.FlatMap(self._refs)
            | "Deal" >> beam.Reshuffle()
        )
        read = photos | Read()
        seen = read.made | "Spread" >> beam.Reshuffle() | Placard(self.bench)
        _ = (
            (seen.made, seen.rejected, read.rejected)
            | beam.Flatten()
            | "Told" >> beam.Map(told)
            | "Parts" >> beam.WithKeys(self._part)
            | "Gather" >> beam.GroupByKey()
            | "Write" >> beam.MapTuple(self._write)
        )

    def _refs(self, piece: Piece) -> Iterator[PhotoRef]:
        if stopping.asked():
            return
        for table in self.bench.store.read_groups(WANTED, piece):
            for name in table.column("name").to_pylist():
                yield PhotoRef(self.root, name, ())

    def _part(self, row: dict[str, str]) -> int:
        return short(row["name"]) % self.parts

    def _write(self, part: int, rows: Iterable[dict[str, str]]) -> None:
        if stopping.asked():  # some may lack
            return
        ordered = sorted(rows, key=lambda row: row["name"])
        name = HEARD.format(part)
        self.bench.store.write_table(name, pa.Table.from_pylist(ordered, TOLD))


def wire(bench: Bench, root: str, names: Sequence[str]) -> Wire:
    """Write names where workers read them, in groups, and wire their pipeline."""
    groups = (pa.table({"name": some}, schema=NAME) for some in grouped(names))
    bench.store.write_groups(WANTED, NAME, groups)
    todo = Asked("", len(names), 0, -(-len(names) // GROUP), len(names))
    return Wire(bench, root, todo.pieces(), runs.parts_of(len(names)))


def gathered(store: Store, parts: int, wanted: set[str]) -> list[dict[str, str]]:
    """Read what came of all photographs, and drop it.

    Raises:
        Lost: if something is not told of one.
    """
    files = [name for name in map(HEARD.format, range(parts)) if store.exists(name)]
    rows = [row for name in files for row in store.read_table(name).to_pylist()]
    for name in (WANTED, *files):
        store.drop(name)
    if lost := wanted - {row["name"] for row in rows}:
        words = f"the runner lost {len(lost)} photos' boards, {min(lost)} first"
        raise Lost(f"{words}: index again; what was read is kept")
    return rows


def boards(
    options: PipelineOptions, root: str, names: Sequence[str]
) -> Mapping[str, Heard]:
    """Look at the boards of photographs below a folder, by name.

    Raises:
        Unlocked: if a network's file is not what its lock says.
        Lost: if a runner lost work, or what it made could not be kept.
        Unrun: if a cluster does not answer, or gives up.
    """
    one_thread()
    ours = options.view_as(CityOptions)
    store = Store(ours.city)
    if in_process(options) and ours.stage_seconds:
        POOL.fill()  # before there are threads and open files
    bench = bench_of(ours, store)
    wired = wire(bench, root, names)
    for part in range(wired.parts):  # of a run that was killed
        store.drop(HEARD.format(part))
    launched(options, wired, store)
    rows = gathered(store, wired.parts, set(names))
    return {row["name"]: heard(row, bench) for row in rows}


def heard(row: Mapping[str, str], bench: Bench) -> Heard:
    """Take what was read of one photo's board; its picture waits until it is wanted."""
    if row["reason"]:
        return Heard(why=f"{row['reason']}: {row['detail']}", spoiled=True)
    path = path_of(row["sha256"], bench)
    try:
        return kept(row["sha256"], path, bench.store)
    except (Damaged, FileNotFoundError):
        bench.store.drop(path)
        return Heard(why="what was read of its board is damaged: index once more")


def kept(sha256: str, path: str, store: Store) -> Heard:
    """Read the artifact of one photo's board.

    Raises:
        FileNotFoundError: if there is none.
        Damaged: if it is not what was written.
    """
    (cells,) = store.read_table(path, ["found", "looks"]).to_pylist()
    looks = (placard.Look(tuple(map(tuple, lines))) for lines in cells["looks"])
    return Heard(
        key=sha256[:16],
        found=cells["found"],
        looks=tuple(looks),
        picture=partial(picture, store, path),
    )


def boards_read(
    options: PipelineOptions, root: str, names: Sequence[str]
) -> Mapping[str, Heard]:
    """Tell what is kept of boards that were looked at before, and write nothing.

    Raises:
        Unlocked: if a network's file is not what its lock says.
    """
    ours = options.view_as(CityOptions)
    bench = bench_of(ours, Store(ours.city))
    found: dict[str, Heard] = {}
    for name in names:
        try:
            data = Store(root).read_bytes(name)
            sha256 = hashlib.sha256(data).hexdigest()
            path = path_of(sha256, bench)
            verdict = bench.store.verdict(path)
            if isinstance(verdict, Rejection):
                why = f"{verdict.reason}: {verdict.detail}"
                found[name] = Heard(why=why, spoiled=True)
            else:
                found[name] = kept(sha256, path, bench.store)
        except (Damaged, OSError):
            found[name] = Heard(why="its board is still to be read")
    return found


def picture(store: Store, path: str) -> bytes:
    """Read the picture of a board; of one that is damaged there is none."""
    try:
        return store.read_table(path, ["crop"]).column("crop")[0].as_py() or b""
    except (Damaged, FileNotFoundError):
        return b""
