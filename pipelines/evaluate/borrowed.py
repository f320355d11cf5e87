"""What neighbours' photographs gave a finished city: before and after, block by block.

    hidden    share of the worn texels that the fronts' own photographs do not show
    left      share that no photograph shows
    error     of patches that agree on how a lender lies, median, in texels of the own

A front counts by its texels, as shares of its own size: each front as one.
"""

import json
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np

from pipelines.evaluate import Unmeasurable
from pipelines.store import Damaged, Store, runs


def evaluate(city: Path) -> dict[str, Any]:
    """Sum up what was lent in the run that a city shows.

    Raises:
        Unmeasurable: if the city tells of no loans.
    """
    store = Store(str(city))
    try:
        run = runs.shown(store)
        rows = runs.read_table(store, run, "borrowed")
    except (OSError, ValueError, Damaged) as problem:
        words = f"{city} tells of nothing borrowed: build it again ({problem})"
        raise Unmeasurable(words) from problem
    by_block: dict[str, list[dict[str, Any]]] = defaultdict(list)
    for row in rows:
        by_block[row["front_id"].partition("-")[0]].append(row)
    return {block: summed(own) for block, own in sorted(by_block.items())}


def summed(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Sum up the fronts of one block."""
    fits = [fit for row in rows for fit in json.loads(row["fits"])]
    fitting = [fit for fit in fits if fit["fits"]]
    hidden, left = (float(np.mean([r[n] for r in rows])) for n in ("unseen", "left"))
    return {
        "fronts": len(rows),
        "with lenders": sum(bool(row["lenders"]) for row in rows),
        "lent to": sum(bool(row["photos"]) for row in rows),
        "views": len(fits),
        "left apart": len(fits) - len(fitting),
        "hidden": hidden,
        "left": left,
        "error": float(np.median([fit["error_px"] for fit in fitting]))
        if fitting
        else None,
    }


def text(report: dict[str, Any]) -> str:
    """Write the table."""
    names = ("fronts", "with lenders", "lent to", "views", "left apart")
    lines = [
        f"{'block':8}"
        + "".join(f"{n:>14}" for n in (*names, "hidden", "left", "error"))
    ]
    for block, one in report.items():
        counts = "".join(f"{one[name]:>14}" for name in names)
        error = "-" if one["error"] is None else f"{one['error']:.2f}"
        lines.append(
            f"{block:8}{counts}{one['hidden']:>14.1%}{one['left']:>14.1%}{error:>14}"
        )
    return "\n".join(lines)
