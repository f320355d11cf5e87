"""How far one slip of an archive's list reaches: the law of `measure.slips`, counted.

Each block is laid out from its own rows, as an archive that indexes one block has them.
"""

import csv
from collections import defaultdict
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from nostalgin_core import catalogue
from nostalgin_core.catalogue import Entry
from nostalgin_core.measure import slips
from nostalgin_core.records import Front
from pipelines.evaluate import Unmeasurable

ALL = "all kinds"


def evaluate(path: Path, *, blocks: Sequence[str] = ()) -> dict[str, Any]:
    """Measure every slip of every row of a list.

    Raises:
        Unmeasurable: if no row makes sense, or none is of the blocks.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            read = catalogue.read(list(csv.DictReader(file)), name=path.name)
    except (UnicodeDecodeError, csv.Error) as problem:
        raise Unmeasurable(f"{path} is no CSV in UTF-8 ({problem})") from problem
    by_block: dict[str, list[Entry]] = defaultdict(list)
    for entry in read.entries:
        if not blocks or entry.block in blocks:
            by_block[entry.block].append(entry)
    if not by_block:
        raise Unmeasurable(f"{path} lists no lot that could be laid out")
    return {
        block: counted(slips.outcomes(rows, as_indexed(rows)))
        for block, rows in by_block.items()
    }


def as_indexed(
    sound: Sequence[Entry],
) -> Callable[[Sequence[Entry]], tuple[Sequence[Front], Sequence[str]]]:
    """Lay a city out as `index` does, and tell what it tells; photos stay as given."""
    photos = sorted({entry.photo for entry in sound if entry.photo})

    def laid_out(rows: Sequence[Entry]) -> tuple[Sequence[Front], Sequence[str]]:
        fronts, doubts = catalogue.fronts(rows)
        _, strangers = catalogue.matched(rows, photos)
        told = [one.text for one in doubts]
        return fronts, [*told, *(f"{one.key}: {one.reason}" for one in strangers)]

    return laid_out


def counted(outcomes: Any) -> dict[str, dict[str, Any]]:
    """Count by kind of slip; shares are of the other fronts of the block."""
    rows: dict[str, list[slips.Outcome]] = defaultdict(list)
    for outcome in outcomes:
        rows[outcome.slip.kind].append(outcome)
        rows[ALL].append(outcome)
    return {kind: shares(rows[kind]) for kind in (*slips.KINDS, ALL) if rows[kind]}


def shares(some: Sequence[slips.Outcome]) -> dict[str, Any]:
    """Sum up the outcomes of one kind."""
    fronts = max(sum(one.fronts for one in some), 1)
    worst = min(
        some, key=lambda one: (one.sides_kept + one.orders_kept) / max(one.fronts, 1)
    )
    return {
        "slips": len(some),
        "side_kept": sum(one.sides_kept for one in some) / fronts,
        "order_kept": sum(one.orders_kept for one in some) / fronts,
        "named": sum(one.named for one in some) / len(some),
        "false_alarms": sum(len(one.false_alarms) for one in some) / len(some),
        "worst": f"row {worst.slip.row}, {worst.slip.told}: {worst.sides_kept} and "
        f"{worst.orders_kept} of {worst.fronts}",
    }


def text(report: dict[str, Any]) -> str:
    """Write the report as a table a block."""
    lines = []
    for block, kinds in report.items():
        head = ("slips", "side %", "order %", "named %", "false")
        lines.append(f"block {block:<18}" + "".join(f"{one:>9}" for one in head))
        for kind, row in kinds.items():
            cells = [f"{row['slips']:>9}"]
            cells += [
                f"{100 * row[one]:>9.2f}"
                for one in ("side_kept", "order_kept", "named")
            ]
            cells.append(f"{row['false_alarms']:>9.2f}")
            lines.append(f"{kind:<24}" + "".join(cells))
        lines += [f"worst: {kinds[ALL]['worst']}", ""]
    return "\n".join(lines[:-1])
