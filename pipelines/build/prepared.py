"""What a run is to do, and with what: looked up before anything is done."""

import os
import time
from dataclasses import dataclass, replace

from pipelines import index, site
from pipelines.build.bench import Bench
from pipelines.build.corrected import Corrected, corrected
from pipelines.build.isolation import Limits
from pipelines.build.options import CityOptions
from pipelines.index import manifest
from pipelines.index.asked import ASKED, Asked, Shard, Warn, ask
from pipelines.index.manifest import Unusable
from pipelines.index.source import Source, found
from pipelines.models import NETWORKS, Models
from pipelines.store import Store, runs
from pipelines.store.versions import Versions


@dataclass(frozen=True)
class Prepared:
    """A run that may begin."""

    bench: Bench
    todo: Asked
    mended: Corrected
    anchors: index.Anchors


def prepared(ours: CityOptions, store: Store, shard: Shard, warn: Warn) -> Prepared:
    """Find what a run is asked for, and write that down beside its tables.

    Raises:
        Unusable: if the manifest can't be read, or asks for nothing.
        Unlocked: if a network's file is not what its lock says.
        Foreign: if the site's folder is another's.
    """
    there = written_anew(store)
    mended = corrected(store, there)
    anchors = anchored(store, there)
    for line in anchors.warnings:
        warn(line)
    bench = bench_of(ours, store)
    if shard == (1, 1):
        site.claim(store)  # whose folder it is, too, is told now
    schemes = [one for one in ours.allow_schemes.split(",") if one]
    sources = there.sha256 + mended.sha256 + anchors.sha256
    words = " ".join([ours.shard, *schemes, *(["png"] if ours.no_webp else [])])
    run = runs.run_id(sources, bench.versions, words)
    own = {"schemes": schemes, "shard": shard, "warn": warn}
    todo = ask(store, there, run, results=mended.rows, **own)
    if shard == (1, 1) and not todo.blocks:
        store.drop(runs.table_path(run, ASKED))
        store.drop_folder(f"runs/{run}")
        raise Unusable(nothing(store, todo))
    return Prepared(bench, todo, mended, anchors)


def bench_of(ours: CityOptions, store: Store) -> Bench:
    """Set out what stages work with; a spoiled network is told here, not by photos."""
    models = Models(ours.models) if ours.models else Models()
    for network in NETWORKS:
        models.load(network)
    limits = Limits(ours.stage_seconds, ours.stage_gigabytes)
    near = replace(store, era=f"{os.getpid()}.{time.time_ns()}")
    form = "png" if ours.no_webp else "webp"
    return Bench(near, Versions.present(models), models, limits, ours.retry, form)


def written_anew(store: Store) -> Source:
    """Find the manifest; one that was mended by hand is written anew before.

    Raises:
        Unusable: if it can't be read.
    """
    there = found(store)
    if not there.mended:
        return there
    manifest.rewrite(store, manifest.read(store))  # which holds all rows
    return found(store)


def anchored(store: Store, there: Source) -> index.Anchors:
    """Read where blocks lie, if the city folder tells it of any."""
    blocks: set[str] = set()
    if index.told_of_places(store):
        cells = (one for batch in there.batches() for one in batch)
        blocks = {str(one.get("block") or "").strip() for one in cells} - {""}
    return index.load(store, sorted(blocks, key=manifest.natural))


def nothing(store: Store, todo: Asked) -> str:
    """Say that there is nothing to build, and what is wrong with the first row."""
    one = todo.first
    why = "it has no rows" if one is None else f"{one.key}: {one.reason}: {one.detail}"
    return f"{store.root}/{manifest.CSV} names no front to build: {why}"
