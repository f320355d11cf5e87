"""What blocks are told beside their rows in a run of two times: old where they wait."""

from collections.abc import Callable, Mapping
from typing import Any

from pipelines.index.asked import short
from pipelines.reprocess.plan import Plan
from pipelines.reprocess.sides import CUT, OF_PHOTOS

Told = Mapping[str, Any]


def told_of_both(plan: Plan) -> dict[str, dict[str, Any]]:
    """Tell each block, and each photograph, what the run is made by."""
    old, new = plan.before.directed(), plan.now.mended.told()
    waiting = set(plan.waiting.tolist())
    lots = lots_of(plan, waiting)

    def waits(name: str) -> bool:
        return short(name) in waiting

    told = {name: of_both(old.get(name, {}), new[name], waits) for name in OF_PHOTOS}
    heights_m = old.get("heights_m", {}), new["heights_m"]
    told["heights_m"] = of_both(*heights_m, lots.__contains__)
    told[CUT] = of_both(plan.stale.cut_before, plan.stale.side.cut, waits)
    return told


def of_both(old: Told, new: Told, waits: Callable[[str], bool]) -> dict[str, Any]:
    """Take of each subject what it was told, or is told now."""
    kept = {name: one for name, one in old.items() if waits(name)}
    return kept | {name: one for name, one in new.items() if not waits(name)}


def lots_of(plan: Plan, waiting: set[int]) -> set[str]:
    """Name the buildings of blocks that wait."""
    found: set[str] = set()
    for table in plan.before.asked():
        cells = (table.column(name).to_pylist() for name in ("block", "lot"))
        found |= {
            f"{b}-{n}" for b, n in zip(*cells, strict=True) if short(b or "") in waiting
        }
    return found
