"""How right a finished city's heights are, by storeys that were counted by eye.

`storeys.csv` has a row a photograph: `id` (.._00993_0008a: block and lot), `storeys`,
`blank` (no rows of windows, an estimate), `sure` (0: a guess) and `note`. A lot's truth
is the median of its rows, times what a storey is usually high. Lots that are guessed
at, or counted to a setback only, have no truth; blank ones are told apart.
"""

import csv
import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import Any, Final

from nostalgin_core.catalogue import from_file_name
from pipelines.evaluate import Unmeasurable
from pipelines.store import Store, runs

STOREY_M: Final = 3.6
NEAR: Final = 0.25  # of the truth
SETBACK: Final = re.compile(r"\bto (first )?setback")
COUNTED, BLANK, NONE = "counted by eye", "without rows of windows", "without a truth"

Lot = tuple[str, str]  # block and lot
Row = dict[str, Any]


def evaluate(data: Path, city: Path) -> dict[str, Any]:
    """Compare the published run of a city with the storeys that were counted.

    Raises:
        Unmeasurable: if nothing was counted, or no such lot was built.
    """
    truth = counted(data / "storeys.csv")
    store = Store(str(city))
    try:
        run = runs.shown(store)
        built = runs.read_table(store, run, "buildings")
    except (OSError, ValueError) as problem:
        raise Unmeasurable(f"{city} has no finished run: build it first") from problem
    rows = compared(truth, built)
    if not rows:
        raise Unmeasurable(f"no lot of {data / 'storeys.csv'} was built in {city}")
    kinds = {kind: summed(rows, kind) for kind in (COUNTED, BLANK)}
    return {**kinds, NONE: sum(row["kind"] == NONE for row in rows), "lots": rows}


def counted(path: Path) -> dict[Lot, tuple[float, str]]:
    """Read each lot's height in metres, and of which kind its truth is.

    Raises:
        Unmeasurable: if a row names no lot or no count.
    """
    lots: dict[Lot, list[dict[str, str]]] = defaultdict(list)
    with path.open(encoding="utf-8-sig", newline="") as file:
        for number, row in enumerate(csv.DictReader(file), 2):
            lot = from_file_name(row.get("id") or "")
            if lot is None or not (row.get("storeys") or "").isdecimal():
                raise Unmeasurable(f"{path} row {number}: needs an id and storeys")
            lots[lot].append(row)
    return {
        lot: (STOREY_M * median(int(row["storeys"]) for row in rows), kind(rows))
        for lot, rows in lots.items()
    }


def kind(rows: Sequence[Mapping[str, str]]) -> str:
    """Tell what a lot's count is worth."""
    guessed = all(row["sure"] == "0" for row in rows)
    if guessed or any(SETBACK.search(row["note"]) for row in rows):
        return NONE
    return BLANK if all(row["blank"] == "1" for row in rows) else COUNTED


def compared(truth: Mapping[Lot, tuple[float, str]], built: Sequence[Row]) -> list[Row]:
    """Put each building beside its truth; of a lot with several, each counts."""
    rows = []
    for one in built:
        if (one["block"], one["lot"]) not in truth:
            continue
        true_m, kind = truth[one["block"], one["lot"]]
        known = one["height_low_m"] is not None
        rows.append(
            {
                "building": one["building_id"],
                "kind": kind,
                "true_m": true_m,
                "near": abs(one["height_m"] / true_m - 1) <= NEAR,
                "held": known and one["height_low_m"] <= true_m <= one["height_high_m"],
                **{name: one[name] for name in one if name.startswith("height_")},
            }
        )
    return sorted(rows, key=lambda row: row["building"])


def summed(rows: Sequence[Row], kind: str) -> dict[str, Any]:
    """Count the lots of one kind."""
    own = [row for row in rows if row["kind"] == kind]
    return {
        "lots": len(own),
        "near": sum(row["near"] for row in own),
        "held": sum(row["held"] for row in own),
        "supported": sum(bool(row["height_supported"]) for row in own),
        "contradicted": sum(bool(row["height_contradicted_by"]) for row in own),
    }


def text(report: dict[str, Any]) -> str:
    """Write the report: a row a kind, then those that are wrong, by name."""
    head = ("lots", "near", "held", "supported", "contradicted")
    lines = [f"{'':<26}" + "".join(f"{one:>14}" for one in head)]
    lines += [
        f"{kind:<26}" + "".join(f"{report[kind][one]:>14}" for one in head)
        for kind in (COUNTED, BLANK)
    ]
    lines += [f"{NONE:<26}{report[NONE]:>14}", ""]
    for row in report["lots"]:
        if row["kind"] != NONE and not (row["near"] and row["held"]):
            lines.append(wrong(row))
    lines.append(f"near: within {NEAR:.0%} of storeys x {STOREY_M} m")
    return "\n".join(lines)


def wrong(row: Row) -> str:
    """Tell one lot whose height, or whose interval, is wrong."""
    low_m, high_m = row["height_low_m"], row["height_high_m"]
    between = "" if low_m is None else f" ({low_m:.0f} to {high_m:.0f})"
    says = {
        name: row[f"height_by_{name}_m"]
        for name in ("storeys", "width", "list")
        if row[f"height_by_{name}_m"] is not None
    }
    told = ", ".join(f"{name} {at_m:.1f}" for name, at_m in says.items())
    assumed = "" if row["height_supported"] else ", assumed"
    return (
        f"{row['building']:<12} {row['height_m']:6.1f} m{between} for "
        f"{row['true_m']:.1f}{assumed}; {told or 'no witness alone'}"
    )
