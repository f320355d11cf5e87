"""The pipeline of a city: from photos to facades, from facades to blocks.

    rows --Plan--> photos, and blocks with their fronts
    photos --Read--Segment--Matte--Rectify--> facades (numbers)
    facades + blocks --GroupByKey block--Assign--> cuboids, and which facades they wear
    worn facades + those of the same fronts --Borrow--Inpaint--> finished
    finished + cuboids --GroupByKey block--Model--> GLB

Only references pass between steps. A facade that no wall wears is never inpainted.
"""

from collections.abc import Iterable
from typing import Any, NamedTuple

import apache_beam as beam
from apache_beam import pvalue

from pipelines.build.bench import Bench
from pipelines.build.blocks import Assign, Model
from pipelines.build.corrected import Corrected
from pipelines.build.kin import akin
from pipelines.build.planned import Plan
from pipelines.build.stages import (
    FacadeRef,
    Matte,
    Read,
    Rectify,
    Segment,
    Thumbnail,
)
from pipelines.build.worn import Borrow, Inpaint, Worn
from pipelines.index.asked import Asked


class Built(NamedTuple):
    """What a build knows at its end: references and reasons."""

    photos: pvalue.PCollection  # read
    facades: pvalue.PCollection  # rectified
    placed: pvalue.PCollection  # blocks with cuboids
    borrowed: pvalue.PCollection  # worn facades, with what neighbours lend to them
    blocks: pvalue.PCollection  # blocks with models
    rejections: pvalue.PCollection


def city(
    pipeline: beam.Pipeline, asked: Asked, bench: Bench, mended: Corrected | None = None
) -> Built:
    """Wire the whole way from photos to blocks."""
    planned: Any = pipeline | Plan(bench.store, asked, mended or Corrected())
    read = planned.photos | "Same build" >> beam.Map(akin, bench) | Read()
    small = read.made | Thumbnail(bench)
    found = read.made | Segment(bench)
    matted = found.made | Matte(bench)
    facades = matted.made | Rectify(bench)
    by_block = facades.made | "By block" >> beam.FlatMap(keyed)
    placed = (
        {"task": planned.blocks, "facades": by_block}
        | "Group facades" >> beam.CoGroupByKey()
        | Assign(bench)
    )
    borrowed = (
        placed.made
        | "Worn" >> beam.FlatMap(lambda one: one.worn())
        | "Spread facades" >> beam.Reshuffle()
        | Borrow(bench)
    )
    finished = borrowed.made | Inpaint(bench)
    blocks = (
        {
            "placed": placed.made
            | "Name blocks" >> beam.Map(lambda one: (one.key, one)),
            "finished": finished.made | "By block again" >> beam.FlatMap(worn_by),
        }
        | "Group finished" >> beam.CoGroupByKey()
        | "With cuboids" >> beam.Filter(lambda group: group[1]["placed"])
        | Model(bench)
    )
    stages = (
        *(read, small, found, matted, facades),
        *(placed, borrowed, finished, blocks),
    )
    rejected = tuple(stage.rejected for stage in stages)
    rejections = (*rejected, planned.rejections) | "Rejections" >> beam.Flatten()
    return Built(
        *(read.made, facades.made, placed.made),
        *(borrowed.made, blocks.made, rejections),
    )


def keyed(ref: FacadeRef) -> Iterable[tuple[str, Any]]:
    """Send a facade to every block that its photo may show."""
    return [(block, ref) for block in ref.photo.blocks]


def worn_by(one: Worn) -> Iterable[tuple[str, Any]]:
    """Send what a wall wears to every block that its photo may show."""
    return [(block, one) for block in one.own.photo.blocks]
