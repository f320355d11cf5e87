"""The rows that a run was asked for become photos and blocks, inside the pipeline.

    pieces --Reshuffle--rows--> by photo --GroupByKey--> photos
                            --> by block --GroupByKey--> blocks
                            --> rejections

The graph names pieces of a table, of which there are few, and no row: it is as large
for a million photos as for ten.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import apache_beam as beam
from apache_beam import pvalue

from nostalgin_core.records import Rejection
from pipelines import stopping
from pipelines.build.corrected import Corrected
from pipelines.index import asked
from pipelines.index.asked import Asked, Piece
from pipelines.index.plan import Name, block_task, photo_ref
from pipelines.index.roots import rooted
from pipelines.index.row import Row
from pipelines.store import Store


class Planned(NamedTuple):
    """What there is to do, and what can't be done."""

    photos: pvalue.PCollection
    blocks: pvalue.PCollection  # with their names before them
    rejections: pvalue.PCollection


@dataclass
class Plan(beam.PTransform):
    """A pipeline in; photos, blocks and rejections out, as `plan` makes them."""

    store: Store
    asked: Asked
    mended: Corrected = field(default_factory=Corrected)

    def expand(self, pipeline: Any) -> Any:
        """Wire the stage."""
        sent: Any = (
            pipeline
            | "Pieces" >> beam.Create(self.asked.pieces())
            | "Rows"
            >> beam.FlatMap(self._sent)
            .with_output_types(
                tuple[tuple[str, str], str],
                fronts=tuple[str, Row],
                refused=Rejection,
            )
            .with_outputs("fronts", "refused", main="photos")
        )
        photos = (
            sent.photos
            | "By photo" >> beam.GroupByKey()
            | "Photos" >> beam.MapTuple(photo_ref)
            | "Drawn" >> beam.Map(self.mended.drawn)
        )
        blocks = (
            sent.fronts
            | "By block" >> beam.GroupByKey()
            | "Blocks" >> beam.MapTuple(self._task)
        )
        return Planned(photos, blocks, sent.refused)

    def _sent(self, piece: Piece) -> Iterator[Any]:
        if stopping.asked():
            return
        for row in asked.rows(self.store, self.asked.run, piece):
            if isinstance(row, Rejection):
                yield pvalue.TaggedOutput("refused", row)
                continue
            block = asked.block_of(row)
            yield pvalue.TaggedOutput("fronts", (block, row))
            if row.photo:
                name: Name = (rooted(row.root, self.store.root), row.photo)
                yield name, block

    def _task(self, block: str, rows: Iterable[Row]) -> Any:
        ordered = sorted(rows, key=in_order)
        task = block_task(block, ordered, city=self.store.root)
        return block, self.mended.directed(task)


def in_order(row: Row) -> tuple[int, str, str]:
    """Order rows by number; a correction may have made several of one."""
    return row.number, row.front.front_id if row.front else "", row.photo
