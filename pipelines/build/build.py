"""One build from its manifest to its published run."""

import time
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from functools import partial
from typing import Any, Final

import apache_beam as beam
from apache_beam.options.pipeline_options import PipelineOptions

from pipelines import plural, site, stopping
from pipelines.build import cluster, rows, twin
from pipelines.build.bench import Bench
from pipelines.build.city import Built, city
from pipelines.build.embedded import in_process
from pipelines.build.isolation import POOL
from pipelines.build.noted import cpu_s, note, stages
from pipelines.build.options import CityOptions, part
from pipelines.build.passes import worked
from pipelines.build.prepared import Prepared, prepared
from pipelines.build.report import (
    Lost,
    Rejections,
    Report,
    check,
    last_shown,
    remember,
    reported,
    shown_before,
)
from pipelines.build.rows import WriteTable
from pipelines.build.tidied import tidied
from pipelines.index.asked import Asked
from pipelines.models import one_thread
from pipelines.store import Damaged, Store, held
from pipelines.store.refuse import drop_run

HEALINGS: Final = 3  # as often a run is repeated for what was damaged on the way
LEAST_SHOWN: Final = 0.5  # of the photos: a city that shows more is never held back

Tell = Callable[..., None]  # an event's word, a line for people, facts for machines
Count = Callable[[], dict[str, int]]  # the artifacts of each stage
Watch = Callable[[Count, int], AbstractContextManager[object]]  # of so many photos


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
        Stopped: if somebody asked to end (`stopping`).
    """
    readied(options)
    ours = options.view_as(CityOptions)
    store, shard = Store(ours.city), part(ours.shard)
    with held(store, shared=shard != (1, 1)):
        return made(options, store, shard, tell, watch)


def readied(options: PipelineOptions) -> None:
    """Ready this process for a run, before there are threads and open files.

    Raises:
        Unrun: if a cluster does not answer.
    """
    one_thread()
    ours = options.view_as(CityOptions)
    if in_process(options) and ours.stage_seconds:
        POOL.fill()  # before there are threads and open files
    cluster.reached(options)  # which takes a second, where somebody is there


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
    return carried_out(options, asked_for, shard, tell, watch)


def carried_out(
    options: PipelineOptions,
    asked_for: Prepared,
    shard: tuple[int, int],
    tell: Tell,
    watch: Watch,
) -> Report:
    """Do what a run is asked for, check that nothing was lost, and publish."""
    ours, store = options.view_as(CityOptions), asked_for.bench.store
    bench, todo, run = asked_for.bench, asked_for.todo, asked_for.todo.run
    counts = {"photos": todo.photos + todo.unplaced, "blocks": todo.blocks}
    told = (plural.of(n, name.removesuffix("s")) for name, n in counts.items())
    words = f"run {run}: {', '.join(told)}"
    tell("start", words, run=run, **counts)
    began = time.time()
    expected = {"estimated": asked_for.expected} if asked_for.expected else {}
    told_of = {**asked_for.told_of, **expected}
    noted = partial(note, store, run, bench.versions, options, began, told_of=told_of)
    noted()  # a folder that can't be written to is told now
    watched = watch if "://" not in store.root else unwatched
    again = 0
    for _ in range(HEALINGS):
        with watched(partial(bench.versions.counts, store.root), todo.photos):
            results = worked(options, partial(wired, asked_for), store, asked_for.work)
        check(store, asked_for.work.run, bench.versions)
        asked_for.settle()
        stopping.check()  # from here on to its end: the run is noted, and shown
        done = stages(*results)
        told = noted(done=done)
        again += sum(one.get("healed", 0) for one in done.values())
        report = replace(reported(store, run, todo), healed=again)
        report = replace(report, cpu_seconds=told["cpu_seconds"])
        report = recognised(asked_for, report)
        if shard != (1, 1) or not report.blocks:
            metered(store, told, ours.shard)
            return report
        try:
            anyway = ours.publish_anyway
            shown = published(asked_for, report, tell, anyway=anyway)
        except Damaged:
            spoiled = site.damaged(store, report.run, bench.versions)
            for path in spoiled:
                store.drop(path)
            again += len(spoiled)
        else:
            if shown.run != run:
                drop_run(store, run)
            tidied(options, store, bench.versions)
            metered(store, told, ours.shard)
            return shown
    raise Lost(f"{store.root}: what is written there is damaged: mend its disk")


def recognised(asked_for: Prepared, report: Report) -> Report:
    """Take a run that came to what an earlier one did for that."""
    store, first = asked_for.bench.store, asked_for.first
    same = twin.same_as_earlier(store, first, report.run) if first else ""
    if not same:
        return report
    return replace(report, run=same, rejections=Rejections(store, same))


def made_alone(options: PipelineOptions, asked_for: Prepared, watch: Watch) -> Report:
    """Make artifacts that a later run finds; no run is noted, and nothing published."""
    bench, work = asked_for.bench, asked_for.work
    store = bench.store
    watched = watch if "://" not in store.root else unwatched
    with watched(partial(bench.versions.counts, store.root), asked_for.todo.photos):
        results = worked(options, partial(wired, asked_for), store, work)
    check(store, work.run, bench.versions)
    done = stages(*results).values()
    again = sum(one.get("healed", 0) for one in done)
    report = replace(reported(store, work.run, work), healed=again)
    report = replace(report, run=asked_for.todo.run, cpu_seconds=cpu_s(done))
    tidied(options, store, bench.versions)
    return report


def warned(tell: Tell, warning: str) -> None:
    """Tell what was noticed in the manifest."""
    tell("warning", f"warning: {warning}", warning=warning)


def metered(store: Store, told: dict[str, Any], shard: str) -> None:
    """Write what a run came to for Prometheus."""
    from pipelines.build import prometheus  # which loads a web server, too

    prometheus.write(store, told, shard, succeeded=last_shown(store))


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
    told = {"title": todo.title, "anchors": asked_for.anchors}
    told["trusting"] = asked_for.trusting
    for doubt in site.publish(store, report.run, bench.versions, **told):
        warned(tell, doubt)
    remember(store, report)
    if "://" in store.root:
        words = f"no site was written: build {store.root} where it is mounted"
        tell("warning", f"warning: {words}", warning=words)
    return report


def wired(
    asked_for: Prepared, todo: Asked, parts: int, pipeline: beam.Pipeline
) -> None:
    """Wire a build, or a pass of it: its stages, and its tables."""
    bench, mended = asked_for.bench, asked_for.mended.directions()
    write(city(pipeline, todo, bench, mended), bench, todo.run, parts)


def write(built: Built, bench: Bench, run: str, parts: int) -> None:
    """Wire the run's tables."""
    store, of = bench.store, bench.versions
    for name, elements, of_each in (
        ("photos", built.photos, rows.photo_rows),
        ("stamps", built.photos, rows.stamp_rows),
        ("facades", built.facades, rows.FacadeRows(of)),
        ("buildings", built.blocks, rows.BuildingRows(of)),
        ("blocks", built.blocks, rows.block_rows),
        ("claims", built.placed, rows.claim_rows),
        ("borrowed", built.borrowed, rows.BorrowedRows(of)),
        ("rejections", built.rejections, rows.rejection_rows),
    ):
        _ = elements | f"Table {name}" >> WriteTable(store, run, name, of_each, parts)
