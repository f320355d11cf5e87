"""What a run is to do, and with what: looked up before anything is done."""

import json
import os
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final

from pipelines import index, site
from pipelines.build import twin
from pipelines.build.bench import Bench
from pipelines.build.corrected import Corrected, corrected
from pipelines.build.isolation import Limits
from pipelines.build.options import CityOptions
from pipelines.build.streets import Streets
from pipelines.index import manifest
from pipelines.index.asked import ASKED, Asked, Shard, Warn, ask
from pipelines.index.manifest import Unusable
from pipelines.index.source import Source, found
from pipelines.models import NETWORKS, Models
from pipelines.store import Store, key_of, runs
from pipelines.store.versions import Versions

DIRECTED: Final = "directed.json"


@dataclass(frozen=True)
class Prepared:
    """A run that may begin."""

    bench: Bench
    todo: Asked
    mended: Corrected
    anchors: index.Anchors
    told_of: Mapping[str, str]  # hashes of what the run follows from
    redone: Asked | None = None  # what the pipeline is to do, unless it is all
    settle: Callable[[], None] = lambda: None  # puts what was not redone beside it
    trusting: bool = False  # that what stands in the site is what we wrote there
    expected: Mapping[str, Any] = field(default_factory=dict)  # what it was to cost
    first: str = ""  # the name of the first run over the same, of a whole run

    @property
    def work(self) -> Asked:
        """Name the rows that the pipeline works on."""
        return self.todo if self.redone is None else self.redone


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
    mended = replace(mended, streets=Streets(anchors.widths_m, anchors.gaps_m))
    bench = bench_of(ours, store)
    if shard == (1, 1):
        site.claim(store)  # whose folder it is, too, is told now
    sources = sources_of(there, mended, anchors)
    first = runs.run_id(sources, bench.versions, words_of(ours))
    run = twin.unshown(store, first)
    own = {"schemes": schemes_of(ours), "shard": shard, "warn": warn}
    todo = ask(store, there, run, results=mended.rows, **own)
    if shard == (1, 1) and not todo.blocks:
        store.drop(runs.table_path(run, ASKED))
        store.drop_folder(f"runs/{run}")
        raise Unusable(nothing(store, todo))
    direct(store, run, mended.told())
    told_of = told_of_run(there, mended, anchors, schemes_of(ours))
    return Prepared(bench, todo, mended, anchors, told_of, first=first)


def told_of_run(
    there: Source, mended: Corrected, anchors: index.Anchors, schemes: Sequence[str]
) -> dict[str, str]:
    """Tell by which a later run knows what this one was told."""
    rows = key_of(there.sha256, mended.sha256, anchors.sha256, *schemes)
    return {"rows": rows, "places": anchors.sha256, "title": there.title}


def direct(store: Store, run: str, told: Mapping[str, Mapping[str, Any]]) -> None:
    """Write beside a run's tables what people told, and places, that no row tells."""
    index.keep(store, f"runs/{run}")
    if any(told.values()):
        data = json.dumps(told, sort_keys=True).encode()
        store.write_bytes(f"runs/{run}/{DIRECTED}", data)


def sources_of(there: Source, mended: Corrected, anchors: index.Anchors) -> str:
    """Hash the files that tell what a run is asked for."""
    return there.sha256 + mended.sha256 + anchors.sha256


def schemes_of(ours: CityOptions) -> list[str]:
    """List the schemes that roots may have."""
    return [one for one in ours.allow_schemes.split(",") if one]


def words_of(ours: CityOptions) -> str:
    """Write the options that change what comes of a run."""
    return written_words(ours.shard, schemes_of(ours), png=ours.no_webp)


def written_words(shard: str, schemes: Sequence[str], *, png: bool) -> str:
    """Write a shard, schemes and the textures' form in one."""
    return " ".join([shard, *schemes, *(["png"] if png else [])])


def bench_of(ours: CityOptions, store: Store) -> Bench:
    """Set out what stages work with; a spoiled network is told here, not by photos."""
    models = Models(ours.models)
    for network in NETWORKS:
        models.load(network)
    limits = Limits(ours.stage_seconds, ours.stage_gigabytes)
    near = replace(store, era=f"{os.getpid()}.{time.time_ns()}")
    form = "png" if ours.no_webp else "webp"
    mark = mark_of(store)
    versions = Versions.present(models, mark=index.watermark_sha256(mark))
    return Bench(near, versions, models, limits, ours.retry, form, mark)


def mark_of(store: Store) -> bytes:
    """Read the file of the watermark that a city's profile tells of, if it does.

    Raises:
        Unusable: if the profile makes no sense.
    """
    try:
        return index.of_city(store).mark
    except index.Nothing as problem:
        raise Unusable(str(problem)) from problem


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
