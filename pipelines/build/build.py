"""One build from its manifest to its published run."""

import copy
import json
import re
import time
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Final

import apache_beam as beam
from apache_beam.options.pipeline_options import PipelineOptions, StandardOptions
from apache_beam.runners.runner import PipelineResult

from nostalgin_core.records import Rejection
from pipelines import site
from pipelines.build import cluster, embedded, rows
from pipelines.build.city import Built, city
from pipelines.build.options import CityOptions, part
from pipelines.build.rows import WriteTable
from pipelines.build.stages import Bench
from pipelines.index import manifest
from pipelines.index.manifest import Manifest, Unusable
from pipelines.index.plan import Plan, plan
from pipelines.index.roots import located
from pipelines.models import NETWORKS, Models, one_thread
from pipelines.store import Store, Unstored, runs
from pipelines.store.versions import Versions

Tell = Callable[..., None]  # an event's word, a line for people, facts for machines
Count = Callable[[], dict[str, int]]  # the artifacts of each stage
Watch = Callable[[Count, int], AbstractContextManager[object]]  # of so many photos


# As a worker's traceback has it; a run's tables are written without `keep`.
UNWRITTEN: Final = (
    rf"{Unstored.__name__}: (.*)",
    r"(?:OS|Permission|[A-Z]\w+Directory)Error: (.*)",
)


class Lost(RuntimeError):  # noqa: N818 - it reads as what it is about
    """Work that a runner neither did nor rejected, or that could not be kept."""


@dataclass(frozen=True)
class Report:
    """What came of a build."""

    run: str
    photos: int
    rejected_photos: int
    facades: int
    blocks: int
    buildings: int
    assumed: int
    rejections: tuple[dict[str, Any], ...]

    @property
    def rejected_share(self) -> float:
        """Tell which share of the photos gave nothing at all."""
        return self.rejected_photos / max(self.photos, 1)

    def grave(self) -> list[dict[str, Any]]:
        """List the rejections that are of more than one facade among others."""
        return [one for one in self.rejections if one["facade"] is None]

    def reasons(self) -> list[tuple[str, int]]:
        """Count rejections by stage and reason, most first."""
        counted = Counter(f"{r['stage']}: {r['reason']}" for r in self.rejections)
        return sorted(counted.items(), key=lambda one: (-one[1], one[0]))


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
        Unrun: if a cluster does not answer, or gives up.
    """
    one_thread()
    ours = options.view_as(CityOptions)
    store, shard = Store(ours.city), part(ours.shard)
    schemes = [one for one in ours.allow_schemes.split(",") if one]
    found = manifest.rewrite(store, manifest.read(store))
    found = located(found, store.root, schemes)
    for warning in found.warnings:
        tell("warning", f"warning: {warning}", warning=warning)
    models = Models(ours.models) if ours.models else Models()
    for network in NETWORKS:
        models.load(network)  # a spoiled file is told here, not by every photo
    bench = Bench(store, Versions.present(models), models)
    todo = plan(found.rows, city=ours.city, shard=shard)
    if shard == (1, 1) and not todo.blocks:
        raise Unusable(nothing(store, (*found.rejections, *todo.rejections)))
    if shard == (1, 1):
        site.claim(store)  # whose folder it is, too, is told now
    asked = " ".join([ours.shard, *schemes])
    run = runs.run_id(found.sha256, bench.versions, asked)
    counts = {"photos": len(todo.photos), "blocks": len(todo.blocks)}
    words = f"run {run}: {counts['photos']} photos, {counts['blocks']} blocks"
    tell("start", words, run=run, **counts)
    began = time.time()
    note(store, run, options, began)  # a folder that can't be written to is told now
    cluster.reached(options)
    near = watch if "://" not in store.root else unwatched
    with near(partial(bench.versions.counts, store.root), len(todo.photos)):
        result = launched(options, todo, found, bench, run)
    check(store, run, todo)
    note(store, run, options, began, stages(result))
    report = reported(store, run, todo)
    if shard == (1, 1) and report.blocks:
        site.publish(store, run, bench.versions, found.rows, title=found.title)
        if "://" in store.root:
            words = f"no site was written: build {store.root} where it is mounted"
            tell("warning", f"warning: {words}", warning=words)
    return report


def nothing(store: Store, rejections: Sequence[Rejection]) -> str:
    """Say that there is nothing to build, and what is wrong with the first row."""
    told = [f"{one.key}: {one.reason}: {one.detail}" for one in rejections[:1]]
    why = "".join(told) or "it has no rows"
    return f"{store.root}/{manifest.CSV} names no front to build: {why}"


def launched(
    options: PipelineOptions, todo: Plan, found: Manifest, bench: Bench, run: str
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
            write(city(pipeline, planned(todo, found), bench), bench, run)
            result = pipeline.run()
            result.wait_until_finish()
        return result
    given = copy.deepcopy(options)  # which the embedded runner changes for itself
    pipeline = beam.Pipeline(embedded.runner(given), options=given)
    write(city(pipeline, planned(todo, found), bench), bench, run)
    try:
        with embedded.on_loopback():
            result = pipeline.run()
            result.wait_until_finish()
    except Unstored as problem:
        raise Lost(unstored(bench.store, str(problem))) from problem
    except RuntimeError as problem:  # a worker's exception reaches us as its traceback
        lines = (re.search(pattern, str(problem)) for pattern in UNWRITTEN)
        told = next((one for one in lines if one is not None), None)
        if told is None:
            raise
        raise Lost(unstored(bench.store, told[1])) from problem
    return result


def planned(todo: Plan, found: Manifest) -> Plan:
    """Join what is to be done with what the manifest's rejections tell."""
    return replace(todo, rejections=(*found.rejections, *todo.rejections))


def unstored(store: Store, why: str) -> str:
    """Say that a run ended because what it made could not be kept."""
    why = why.partition(" [while running")[0]  # which Beam adds
    return (
        f"{store.root} takes no more artifacts: {why}; make room or mend the folder, "
        "and build again: what is kept already is not made twice"
    )


def write(built: Built, bench: Bench, run: str) -> None:
    """Wire the run's tables."""
    store, of = bench.store, bench.versions
    for name, elements, of_each in (
        ("photos", built.photos, rows.photo_rows),
        ("facades", built.facades, rows.FacadeRows(of)),
        ("buildings", built.blocks, rows.BuildingRows(of)),
        ("blocks", built.blocks, rows.block_rows),
        ("rejections", built.rejections, rows.rejection_rows),
    ):
        _ = elements | f"Table {name}" >> WriteTable(store, run, name, of_each)


def check(store: Store, run: str, todo: Plan) -> None:
    """Insist that each photo and each block was made or rejected.

    Raises:
        Lost: if one was neither.
    """
    told = set(runs.read_column(store, run, "rejections", "key"))
    photos = told.union(runs.read_column(store, run, "facades", "name"))
    blocks = told.union(runs.read_column(store, run, "blocks", "block"))
    lost = [ref.name for ref in todo.photos if ref.name not in photos]
    lost += [task.block for task in todo.blocks if task.block not in blocks]
    if lost:
        raise Lost(
            f"the runner lost {len(lost)} photos or blocks, {lost[0]} first: "
            "build again; what was done is kept"
        )


def reported(store: Store, run: str, todo: Plan) -> Report:
    """Sum up a run from its tables."""
    facades = runs.read_column(store, run, "facades", "name")
    seen = set(facades)
    buildings = runs.read_column(store, run, "blocks", "buildings")
    return Report(
        run=run,
        photos=len(todo.photos),
        rejected_photos=sum(ref.name not in seen for ref in todo.photos),
        facades=len(facades),
        blocks=len(buildings),
        buildings=sum(buildings),
        assumed=sum(runs.read_column(store, run, "blocks", "assumed")),
        rejections=tuple(runs.read_table(store, run, "rejections")),
    )


def note(
    store: Store,
    run: str,
    options: PipelineOptions,
    began: float,
    done: dict[str, dict[str, int]] | None = None,
) -> None:
    """Write when the run was and what it took: the only file with clock times.

    Until the run is done it tells only when it began.
    """
    given = options.get_all_options(drop_default=True)
    told: dict[str, Any] = {
        "run": run,
        "began": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(began)),
        "options": {name: str(value) for name, value in given.items()},
    }
    if done is not None:
        told |= {"seconds": round(time.time() - began, 1), "stages": done}
    text = json.dumps(told, indent=1, sort_keys=True) + "\n"
    store.write_bytes(f"runs/{run}/run.json", text.encode())


def stages(result: PipelineResult) -> dict[str, dict[str, int]]:
    """Read the counters and times of all stages."""
    metrics = result.metrics().query()
    told: dict[str, dict[str, int]] = {}
    for one in metrics["counters"]:
        mine = told.setdefault(one.key.metric.namespace, {})
        mine[one.key.metric.name] = mine.get(one.key.metric.name, 0) + one.result
    for one in metrics["distributions"]:
        mine = told.setdefault(one.key.metric.namespace, {})
        mine["milliseconds"] = mine.get("milliseconds", 0) + one.result.sum
    return told
