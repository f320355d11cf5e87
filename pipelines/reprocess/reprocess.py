"""What is stale is redone alone, and the next run is published."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Final

import numpy as np
import pyarrow as pa
from apache_beam.options.pipeline_options import DirectOptions, PipelineOptions

from pipelines import build, site
from pipelines.build import CRASHED, CityOptions, Prepared, Report, Tell, Watch
from pipelines.index import asked
from pipelines.index.asked import Asked, short
from pipelines.index.roots import rooted
from pipelines.models import Models
from pipelines.reprocess import merged, tries
from pipelines.reprocess.now import now
from pipelines.reprocess.plan import Plan, planned
from pipelines.reprocess.stale import CAUSES
from pipelines.reprocess.waiting import told_of_both
from pipelines.store import Store, held, key_of, runs
from pipelines.store.refuse import drop_run

OF_FILES: Final = ("new", "changed", "removed", "moved")


@dataclass(frozen=True)
class Reprocessed:
    """What was found stale, and what came of it; no report: nothing was to do."""

    plan: Plan
    report: Report | None = None
    shown: bool = False  # a new city is there to be seen


def reprocess(
    options: PipelineOptions,
    *,
    budget: int = 0,
    thorough: bool = False,
    tell: Tell = build.silent,
    watch: Watch = build.unwatched,
) -> Reprocessed:
    """Find what is stale, redo it, and publish; without anything stale, do nothing.

    The options' `retry` tries again what crashed too often or ended its process, too.

    Raises:
        Unusable, Damaged: if the manifest, or the published run, can't be read.
        Foreign, Lost, Busy, Unrun: as a build.
    """
    build.readied(options)
    ours = options.view_as(CityOptions)
    store = Store(ours.city)
    with held(store):
        build.written_anew(store)
        workers = options.view_as(DirectOptions).direct_num_workers or 1
        models = Models(ours.models)
        asked_now = now(store, models, schemes=build.schemes_of(ours))
        ours.allow_schemes = ",".join(asked_now.schemes)
        ours.no_webp = asked_now.png
        asked = {"budget": budget, "thorough": thorough, "retry": ours.retry}
        plan = planned(asked_now, **asked, workers=workers)
        if plan.nothing:
            return Reprocessed(plan)
        if healing(plan):
            report = noted(plan, healed(options, plan, watch))
            if not recovered(plan, report):
                kept(tell)
                return Reprocessed(plan, report)
        asked_for = prepared(plan, ours)
        ahead = plan.later and not plan.same_versions
        if ahead:
            report = noted(plan, made_ahead(options, asked_for, watch))
            kept(tell)
            return Reprocessed(plan, report)
        report = build.carried_out(options, asked_for, (1, 1), tell, watch)
        merged.drop(store, report.run)
        noted(plan, report)
        return Reprocessed(plan, report, shown=bool(report.blocks and not report.held))


def noted(plan: Plan, report: Report) -> Report:
    """Keep in how many runs each photograph and block has crashed by now."""
    stale, now = plan.stale, plan.now
    anew = np.isin(stale.causes, [CAUSES.index(one) for one in ("new", "changed")])
    of = {"redone": plan.redone, "crashed": stale.crashed, "anew": stale.photos[anew]}
    tries.keep(now.store, now.versions, tries.counted(stale.tried, report, **of))
    return report


def healing(plan: Plan) -> bool:
    """Tell whether artifacts alone are missing: the run stays the one it is."""
    files = any(plan.stale.count(cause) for cause in OF_FILES)
    rows = len(plan.stale.blocks["rows"])
    return bool(
        plan.same_versions
        and not plan.later
        and not (files or rows or plan.stale.moved)
    )


def recovered(plan: Plan, report: Report) -> bool:
    """Tell whether something came through at which the published run had crashed."""
    told = {short(one["key"]) for one in report.rejections if one["reason"] == CRASHED}
    return bool(len(np.setdiff1d(plan.stale.crashed, np.array([*told], np.uint64))))


def healed(options: PipelineOptions, plan: Plan, watch: Watch) -> Report:
    """Make what is missing of the published run."""
    asked_for = prepared(plan, options.view_as(CityOptions), run=plan.before.run)
    return made_ahead(options, asked_for, watch)


def made_ahead(options: PipelineOptions, asked_for: Prepared, watch: Watch) -> Report:
    """Make artifacts that a later run finds, and publish nothing."""
    report = build.made_alone(options, asked_for, watch)
    store, run = asked_for.bench.store, asked_for.todo.run
    # Their table goes with the others of what was redone.
    report = replace(report, rejections=tuple(report.rejections), tabled=False)
    merged.drop(store, run)
    if not store.exists(f"runs/{run}/run.json"):  # none that was published
        drop_run(store, run)
    return report


def kept(tell: Tell) -> None:
    """Tell that no run was published."""
    tell("kept", "artifacts alone were made: the city that is shown stays")


def prepared(plan: Plan, ours: CityOptions, run: str = "") -> Prepared:
    """Write what the next run is asked for, and what of it is to be redone."""
    told, before = plan.now, plan.before
    store = told.store
    bench = build.bench_of(ours, store)
    site.claim(store)
    for path in plan.stale.spoiled:
        store.drop(path)
    given = (told.there, told.mended, told.anchors, told.schemes)
    told_of = build.told_of_run(*given)
    if plan.later:
        told_of["rows"] = ""  # they are of two times: the next run looks at each
    name = run or named(plan)
    todo = Asked(name, plan.stale.photos_asked, plan.blocks_asked, 0, 0)
    if not run:
        todo = written(store, name, rows(plan), told.there.title)
        later = plan.later
        build.direct(store, name, told_of_both(plan) if later else told.mended.told())
        if plan.all_redone or not (plan.later or merged.complete(store, before.run)):
            whole = (bench, todo, told.mended, told.anchors, told_of)
            return Prepared(*whole, expected=plan.expected())
    parts = runs.parts_of(todo.rows)
    of_run = f"{name}/{runs.REDONE}"
    redone = written(
        store, of_run, selected(plan.rows(), plan.redone), told.there.title
    )
    settle = partial(merged.merge, store, name, before.run, parts, plan.redone)
    whole = (bench, todo, told.mended, told.anchors, told_of, redone, settle)
    return Prepared(*whole, trusting=plan.same_small, expected=plan.expected())


def named(plan: Plan) -> str:
    """Name the next run as a build would; if one of that name was shown, by its own."""
    name = plan.now.run
    if not runs.was_shown(plan.now.store, name) and not plan.later:
        return name
    files = np.isin(plan.stale.causes, [CAUSES.index(one) for one in OF_FILES])
    told = (plan.stale.photos[files], plan.stale.since_ns[files], plan.redone)
    words = [repr(one.tolist()) for one in told]
    return key_of(name, plan.before.run, *words)[:12]


def rows(plan: Plan) -> Iterator[pa.Table]:
    """Read the rows of the next run: as they are now, or were where that must wait."""
    if not plan.later:
        yield from plan.rows()
        return
    waiting = plan.waiting
    yield from selected(plan.rows(), waiting, inverse=True)
    for table in selected(plan.before.asked(), waiting):
        yield table.filter(table.column("reason").is_null())


def selected(
    tables: Iterator[pa.Table], nodes: np.ndarray, *, inverse: bool = False
) -> Iterator[pa.Table]:
    """Take the rows of some blocks, or of all others, and those that can't be used."""
    for table in tables:
        names = [short(one or "") for one in table.column("block").to_pylist()]
        mine = np.isin(np.array(names, np.uint64), nodes)
        refused = table.column("reason").is_valid().to_numpy(zero_copy_only=False)
        yield table.filter(pa.array((mine ^ inverse) | refused))


def written(store: Store, run: str, groups: Iterator[pa.Table], title: str) -> Asked:
    """Write rows, and count what they ask for."""
    photos, blocks, unplaced = (asked.Distinct() for _ in range(3))

    def counted() -> Iterator[pa.Table]:
        for table in groups:
            names = ("root", "photo", "block", "reason")
            columns = (table.column(name).to_pylist() for name in names)
            for root, photo, block, reason in zip(*columns, strict=True):
                if reason is None:
                    blocks.add(block)
                if photo:
                    which = photos if reason is None else unplaced
                    which.add(rooted(root, store.root), photo)
            if table.num_rows:
                yield table

    sizes = asked.written(store, run, counted())
    counts = (photos.count(), blocks.count(), *sizes)
    return Asked(run, *counts, title, unplaced=unplaced.beyond(photos))
