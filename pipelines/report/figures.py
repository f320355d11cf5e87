"""The figures of one run, gathered from its tables, a column at a time."""

import json
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

import numpy as np

from pipelines.index.manifest import natural
from pipelines.report.history import Past, current, past, read_json
from pipelines.store import Store, runs

WORST: Final = 12  # of each kind, with their pictures
SHARES: Final = tuple(round(0.1 * i, 1) for i in range(11))  # of a front, photographed
HEIGHTS_M: Final = (0, 5, 10, 15, 20, 30, 45, 70, 200)


class NoRun(ValueError):  # noqa: N818 - it reads as what it is about
    """A city folder in which no run has come to its end."""


@dataclass(frozen=True)
class Bar:
    """One row of a chart."""

    name: str
    value: float
    note: str = ""


@dataclass(frozen=True)
class Times:
    """How long a stage took for one element, by the clock."""

    stage: str
    count: int
    skipped: int
    median_s: float
    p90_s: float
    longest_s: float


@dataclass(frozen=True)
class Picture:
    """A photograph on a contact sheet."""

    photo: str
    key: str  # "" where it could not even be read
    note: str


@dataclass(frozen=True)
class Figures:
    """All that the page tells of a run."""

    past: Past
    photos: int
    useless: int  # photos of which no facade came
    facades: int
    blocks: int
    buildings: int
    assumed: int
    guessed_heights: int
    guessed_widths: int
    reasons: tuple[Bar, ...]
    stages: tuple[Bar, ...]  # CPU seconds
    times: tuple[Times, ...]
    memory_mb: dict[str, int]  # the most that a process of each kind held
    shares: tuple[Bar, ...]  # buildings, by how much of their fronts a camera saw
    heights: tuple[Bar, ...]  # buildings, by height
    of_blocks: tuple[dict[str, Any], ...]
    rejected: tuple[Picture, ...]
    least_seen: tuple[Picture, ...]
    least_sure: tuple[Picture, ...]


def figures(store: Store, run: str = "") -> Figures:
    """Gather a run's figures; without a name, of the one that is shown.

    Raises:
        NoRun: if there is none, or it left no tables.
        Damaged: if a table is.
    """
    run = run or current(store)
    if not run:
        raise NoRun(f"{store.root}: no city was built there yet; run `nostalgin build`")
    try:
        keys = dict(zip(*columns(store, run, "photos", "name", "key"), strict=True))
        seen = runs.read_column(store, run, "facades", "name")
        rejections = runs.read_table(store, run, "rejections")
        records = [
            json.loads(r) for r in runs.read_column(store, run, "blocks", "record")
        ]
    except FileNotFoundError as problem:
        raise NoRun(f"{store.root}: run {run} left no tables; build again") from problem
    buildings = [one for record in records for one in record["buildings"]]
    record = read_json(store, f"runs/{run}/run.json")
    useless = set(keys).difference(seen)
    return Figures(
        past=past(store, run, current(store)),
        photos=len(keys),
        useless=len(useless),
        facades=len(seen),
        blocks=len(records),
        buildings=len(buildings),
        assumed=sum(one["assumed"] for one in buildings),
        guessed_heights=sum(one["height_assumed"] for one in buildings),
        guessed_widths=sum(one["width_assumed"] for one in buildings),
        reasons=reasons(rejections),
        stages=stages(record),
        times=times(record),
        memory_mb=record.get("memory_mb", {}),
        shares=counted((b["photographed_share"] for b in buildings), SHARES, ""),
        heights=counted((b["height_m"] for b in buildings), HEIGHTS_M, " m"),
        of_blocks=tuple(sorted(of_blocks(records), key=by_number)),
        rejected=rejected(rejections, useless, keys),
        least_seen=least_seen(buildings),
        least_sure=least_sure(buildings),
    )


def columns(store: Store, run: str, table: str, *names: str) -> Iterator[list[Any]]:
    """Read some columns of a table."""
    return (runs.read_column(store, run, table, name) for name in names)


def reasons(rejections: Iterable[dict[str, Any]]) -> tuple[Bar, ...]:
    """Count rejections by stage and reason, most first."""
    count = Counter(f"{one['stage']}: {one['reason']}" for one in rejections)
    ordered = sorted(count.items(), key=lambda one: (-one[1], one[0]))
    return tuple(Bar(name, value) for name, value in ordered)


def stages(told: dict[str, Any]) -> tuple[Bar, ...]:
    """Tell where the time of a run went: CPU seconds a stage, and for one element."""
    bars = []
    for name, one in told.get("stages", {}).items():
        spent, made = one.get("cpu_milliseconds", 0) / 1000, one.get("made", 0)
        note = f"{made} made" + (f", {spent / made:.2f} s each" if made else "")
        bars.append(Bar(name, round(spent, 1), note))
    return tuple(sorted(bars, key=lambda bar: (-bar.value, bar.name)))


def times(told: dict[str, Any]) -> tuple[Times, ...]:
    """Tell how long elements took, stage by stage, but for those that were skipped."""
    return tuple(
        Times(
            name,
            count,
            int(one.get("skipped", 0)),
            *(
                one.get(word, 0) / 1000
                for word in ("median_ms", "p90_ms", "longest_ms")
            ),
        )
        for name, one in sorted(told.get("stages", {}).items())
        if (count := sum(one.get("spans", {}).values())) or one.get("skipped")
    )


def counted(
    values: Iterable[float], edges: Sequence[float], unit: str
) -> tuple[Bar, ...]:
    """Count values between edges; the last bin takes what lies beyond it, too."""
    bounded = np.clip(list(values), edges[0], edges[-1])
    count, _ = np.histogram(bounded, edges)
    names = (f"{low:g} to {high:g}{unit}" for low, high in pairwise(edges))
    return tuple(Bar(name, int(n)) for name, n in zip(names, count, strict=True))


def of_blocks(records: Iterable[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """Sum up each block's buildings."""
    for record in records:
        own = record["buildings"]
        heights = [one["height_m"] for one in own] or [0.0]
        yield {
            "block": record["block"],
            "buildings": len(own),
            "assumed": sum(one["assumed"] for one in own),
            "seen": float(np.mean([one["photographed_share"] for one in own] or [0.0])),
            "low_m": min(heights),
            "median_m": float(np.median(heights)),
            "high_m": max(heights),
        }


def by_number(told: dict[str, Any]) -> tuple[int, str]:
    """Order blocks as people count."""
    return natural(told["block"])


def rejected(
    rejections: Iterable[dict[str, Any]], useless: set[str], keys: dict[str, str]
) -> tuple[Picture, ...]:
    """Show photographs of which nothing came, in the order of their names."""
    why = {
        one["key"]: f"{one['stage']}: {one['reason']} {one['detail']}".strip()
        for one in rejections
        if one["key"] in useless
    }
    shown = sorted(useless)[:WORST]
    return tuple(Picture(name, keys[name], why.get(name, "")) for name in shown)


def least_seen(buildings: Iterable[dict[str, Any]]) -> tuple[Picture, ...]:
    """Show the photographs of buildings whose fronts a camera saw least of."""
    worn = [one for one in buildings if any(p["used"] for p in one["photos"])]
    worn.sort(key=lambda one: (one["photographed_share"], one["id"]))
    return tuple(
        pictured(one, f"{one['photographed_share']:.0%} photographed")
        for one in worn[:WORST]
    )


def least_sure(buildings: Iterable[dict[str, Any]]) -> tuple[Picture, ...]:
    """Show the photographs of buildings whose heights are least sure."""
    told = [one for one in buildings if one.get("height_low_m") and one["photos"]]
    told.sort(key=lambda one: (-one["height_high_m"] / one["height_low_m"], one["id"]))
    return tuple(
        pictured(
            one,
            f"{one['height_m']:.0f} m, between {one['height_low_m']:.0f} "
            f"and {one['height_high_m']:.0f}",
        )
        for one in told[:WORST]
    )


def pictured(building: dict[str, Any], note: str) -> Picture:
    """Take the photograph that a building wears, or its first."""
    photos = sorted(building["photos"], key=lambda one: not one["used"])
    where = building["address"] or building["lot"]
    name = photos[0].get("caption", photos[0]["key"])
    return Picture(name, photos[0]["key"], f"{building['id']}, {where}: {note}")
