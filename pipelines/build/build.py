"""One build from its manifest to its published run."""

import contextlib
import copy
import re
import time
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from functools import partial
from typing import Any, Final

import apache_beam as beam
from apache_beam.options.pipeline_options import PipelineOptions, StandardOptions
from apache_beam.runners.runner import PipelineResult

from pipelines import site
from pipelines.build import cluster, embedded, rows
from pipelines.build.bench import Bench
from pipelines.build.city import Built, city
from pipelines.build.corrected import Corrected
from pipelines.build.embedded import in_process
from pipelines.build.isolation import POOL
from pipelines.build.noted import note, stages
from pipelines.build.options import CityOptions, part
from pipelines.build.prepared import Prepared, prepared
from pipelines.build.report import (
    Lost,
    Report,
    check,
    remember,
    reported,
    shown_before,
)
from pipelines.build.rows import WriteTable
from pipelines.index import asked
from pipelines.index.asked import Asked
from pipelines.index.row import Row
from pipelines.models import one_thread
from pipelines.store import Damaged, Store, Unstored, held, pack, runs
from pipelines.store.versions import Versions

HEALINGS: Final = 3  # as often a run is repeated for what was damaged on the way
LEAST_SHOWN: Final = 0.5  # of the photos: a city that shows more is never held back

Tell = Callable[..., None]  # an event's word, a line for people, facts for machines
Count = Callable[[], dict[str, int]]  # the artifacts of each stage
Watch = Callable[[Count, int], AbstractContextManager[object]]  # of so many photos

# As a worker's traceback has it; a run's tables are written without `keep`.
UNWRITTEN: Final = (
    rf"{Unstored.__name__}: (.*)",
    r"(?:OS|Permission|[A-Z]\w+Directory)Error: (.*)",
)


def silent(event: str, text: str, **facts: Any) -> None:
    """Tell nobody."""


def unwatched(count: Count, photos: int) -> AbstractContextManager[object]:
    """Let nobody watch."""
    del count, photos
    return nullcontext()


def build(
    options: PipelineOptions, *, tell: Tell = silent, watch: Watch = unwatched
) -> Report:
    """Build what the manifest asks for, check that nothing was lost, and publish.

    Whoever is there to `tell` hears of it, and may `watch` artifacts being made, where
    the city folder is on this machine; a remote one has its runner's own pages.
    This process is kept to one thread a library, as the workers are (`one_thread`).

    Raises:
        Unusable: if the manifest can't be read, or names no front.
        Foreign: if the folder for the site holds what another wrote.
        Lost: if a runner lost work, or what it made could not be kept.
        Busy: if another run is at work in the city folder.
        Unrun: if a cluster does not answer, or gives up.
    """
    one_thread()
    ours = options.view_as(CityOptions)
    store, shard = Store(ours.city), part(ours.shard)
    if in_process(options) and ours.stage_seconds:
        POOL.fill()  # before there are threads and open files
    cluster.reached(options)  # which takes a second, where somebody is there
    with held(store, shared=shard != (1, 1)):
        return made(options, store, shard, tell, watch)


def made(
    options: PipelineOptions,
    store: Store,
    shard: tuple[int, int],
    tell: Tell,
    watch: Watch,
) -> Report:
    """Build in a city folder that is ours for the time."""
    ours = options.view_as(CityOptions)
    asked_for = prepared(ours, store, shard, partial(warned, tell))
    bench, todo, run = asked_for.bench, asked_for.todo, asked_for.todo.run
    counts = {"photos": todo.photos, "blocks": todo.blocks}
    words = f"run {run}: {counts['photos']} photos, {counts['blocks']} blocks"
    tell("start", words, run=run, **counts)
    began = time.time()
    noted = partial(note, store, run, bench.versions, options, began)
    noted()  # a folder that can't be written to is told now
    watched = watch if "://" not in store.root else unwatched
    again = 0
    for _ in range(HEALINGS):
        with watched(partial(bench.versions.counts, store.root), todo.photos):
            result = launched(options, todo, bench, asked_for.mended)
        check(store, run, bench.versions)
        done = stages(result)
        noted(done=done)
        again += sum(one.get("healed", 0) for one in done.values())
        report = replace(reported(store, run, todo), healed=again)
        if shard != (1, 1) or not report.blocks:
            return report
        try:
            anyway = ours.publish_anyway
            shown = published(asked_for, report, tell, anyway=anyway)
        except Damaged:
            spoiled = site.damaged(store, run, bench.versions)
            for path in spoiled:
                store.drop(path)
            again += len(spoiled)
        else:
            tidied(store, bench.versions)
            return shown
    raise Lost(f"{store.root}: what is written there is damaged: mend its disk")


def warned(tell: Tell, warning: str) -> None:
    """Tell what was noticed in the manifest."""
    tell("warning", f"warning: {warning}", warning=warning)


def tidied(store: Store, versions: Versions) -> None:
    """Pack the artifacts that lie about: what is done, the next run knows by a listing.

    A disk that is full keeps them as they are.
    """
    with contextlib.suppress(OSError):
        for stage in vars(versions):
            pack(store, versions.folder(stage))


def published(
    asked_for: Prepared, report: Report, tell: Tell, *, anyway: bool
) -> Report:
    """Publish a run, unless it shows less than what is published already.

    Raises:
        Damaged: if an artifact is.
    """
    bench, todo = asked_for.bench, asked_for.todo
    store = bench.store
    better = shown_before(store)
    if report.shown_share < min(LEAST_SHOWN, better) and not anyway:
        words = (
            f"the site stays as it is: it shows {better:.0%} of its photos, this run "
            f"{report.shown_share:.0%}: mend what was rejected, or replace it by "
            "`nostalgin build --publish-anyway`"
        )
        tell("held", words, shown=report.shown_share, before=better)
        return replace(report, held=True)
    rows = [one for one in asked.rows(store, report.run) if isinstance(one, Row)]
    told = {"title": todo.title, "anchors": asked_for.anchors}
    for doubt in site.publish(store, report.run, bench.versions, rows, **told):
        warned(tell, doubt)
    remember(store, report)
    if "://" in store.root:
        words = f"no site was written: build {store.root} where it is mounted"
        tell("warning", f"warning: {words}", warning=words)
    return report


def launched(
    options: PipelineOptions, todo: Asked, bench: Bench, mended: Corrected
) -> PipelineResult:
    """Run the pipeline to its end.

    Raises:
        Lost: if what was made could not be kept.
        Unrun: if a cluster gave up.
    """
    runner = options.view_as(StandardOptions).runner
    if runner != embedded.EMBEDDED:
        with cluster.told(runner):
            pipeline = beam.Pipeline(options=options)
            write(city(pipeline, todo, bench, mended.directions()), bench, todo)
            result = pipeline.run()
            result.wait_until_finish()
        return result
    given = copy.deepcopy(options)  # which the embedded runner changes for itself
    pipeline = beam.Pipeline(embedded.runner(given), options=given)
    write(city(pipeline, todo, bench, mended.directions()), bench, todo)
    try:
        with embedded.on_loopback(), embedded.ending_with_a_worker():
            result = pipeline.run()
            result.wait_until_finish()
    except embedded.WorkerLost as problem:
        words = f"{problem}: build again, with fewer workers if memory is short"
        raise Lost(f"{words}; what is kept already is not made twice") from problem
    except Unstored as problem:
        raise Lost(unstored(bench.store, str(problem))) from problem
    except RuntimeError as problem:  # a worker's exception reaches us as its traceback
        lines = (re.search(pattern, str(problem)) for pattern in UNWRITTEN)
        told = next((one for one in lines if one is not None), None)
        if told is None:
            raise
        raise Lost(unstored(bench.store, told[1])) from problem
    return result


def unstored(store: Store, why: str) -> str:
    """Say that a run ended because what it made could not be kept."""
    why = why.partition(" [while running")[0]  # which Beam adds
    return (
        f"{store.root} takes no more artifacts: {why}; make room or mend the folder, "
        "and build again: what is kept already is not made twice"
    )


def write(built: Built, bench: Bench, todo: Asked) -> None:
    """Wire the run's tables."""
    store, of = bench.store, bench.versions
    parts = runs.parts_of(todo.rows)
    for name, elements, of_each in (
        ("photos", built.photos, rows.photo_rows),
        ("facades", built.facades, rows.FacadeRows(of)),
        ("buildings", built.blocks, rows.BuildingRows(of)),
        ("blocks", built.blocks, rows.block_rows),
        ("rejections", built.rejections, rows.rejection_rows),
    ):
        _ = elements | f"Table {name}" >> WriteTable(
            store, todo.run, name, of_each, parts
        )
