"""How right a finished city stands: a lot's street, side, order, width and height.

*street*: one of a lot's fronts stands on a street that its front was seen to look on.
*side*, *order*: for each two lots that a photograph shows as neighbours on one street,
both border one side of the block, the left one left of the right one. *width*: along
the street, within a tenth of the list's. *height*, *interval*: near the storeys that
were counted, and stated to lie where these are (`heights`). A ring's closure is
by how many metres its sides as measured miss their start (before), and along how many
metres of its outline no building stands (after).
"""

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from nostalgin_core.address import plain_name
from nostalgin_core.city import Move
from nostalgin_core.records import Front
from pipelines.evaluate import Unmeasurable, heights
from pipelines.evaluate.grounds import (
    Stretch,
    Told,
    footprint,
    overlapping,
    rings,
    stretches,
)
from pipelines.evaluate.sights import Pair, Sights, sights
from pipelines.index import manifest
from pipelines.index.row import Row
from pipelines.store import Store, runs

NEAR_WIDTH: Final = 0.1  # of the list's
MARKS: Final = ("street", "side", "order", "width", "height", "interval")

Law = Callable[[Stretch, Stretch], bool]


def evaluate(data: Path, city: Path) -> dict[str, Any]:
    """Compare the published run of a city with photographs and list.

    Raises:
        Unmeasurable: if there is no run, or nothing was seen of its lots.
    """
    store = Store(str(city))
    try:
        run = runs.shown(store)
        built = runs.read_table(store, run, "buildings")
        blocks = runs.read_table(store, run, "blocks")
        places = runs.read_table(store, run, "places")
        fronts = standing(manifest.read(store).rows)
    except (OSError, ValueError, manifest.Unusable) as problem:
        raise Unmeasurable(f"{city} has no finished run: build it first") from problem
    seen = sights(data)
    tall = heights.compared(heights.counted(data / "storeys.csv"), built)
    beside = stretches(built, blocks)
    rows = compared(built, fronts, beside, seen, {one["building"]: one for one in tall})
    if not any(row[mark] is not None for row in rows for mark in MARKS):
        raise Unmeasurable(f"{data} shows no lot that was built in {city}")
    moves = {
        one["block"]: Move(one["turn_rad"], one["east_m"], one["north_m"])
        for one in places
    }
    return {
        "lots": rows,
        "rings": [ring for one in blocks for ring in rings(one, built)],
        "overlapping": overlapping(built, moves),
    }


def standing(rows: Sequence[Row]) -> dict[str, Front]:
    """Give the fronts that the manifest tells, by name."""
    own = [one.front for one in rows if one.front is not None]
    return {front.front_id: front for front in reversed(own)}  # the first row counts


def compared(
    built: Sequence[Told],
    fronts: Mapping[str, Front],
    beside: Mapping[str, Sequence[Stretch]],
    seen: Sights,
    tall: Mapping[str, Told],
) -> list[Told]:
    """Put each building beside what is known of its lot; None where nothing is."""
    wrong = {mark: strangers(seen.pairs, beside, law) for mark, law in LAWS.items()}
    paired = {
        lot
        for pair in seen.pairs
        if all(beside.get(one) for one in pair)
        for lot in pair
    }
    return [
        row_of(one, [fronts[name] for name in one["fronts"] if name in fronts], seen)
        | neighbours_of(f"{one['block']}-{one['lot']}", paired, wrong)
        | height_of(one, tall.get(one["building_id"], {}))
        for one in sorted(built, key=lambda one: one["building_id"])
        if not one["assumed"]
    ]


def row_of(one: Told, own: Sequence[Front], seen: Sights) -> Told:
    """Tell whether a building stands on its street, as wide as the list says."""
    faces = seen.faces.get(f"{one['block']}-{one['lot']}", frozenset())
    corners = footprint(one)
    wide = float(np.hypot(*(corners[1] - corners[0])))  # of its first front
    listed = own[0].width_m if own and not own[0].width_assumed else None
    streets = {plain_name(front.street) for front in own}
    return {
        "building": one["building_id"],
        "street": bool(faces & streets) if faces and own else None,
        "stands_on": ", ".join(dict.fromkeys(front.street for front in own)),
        "seen_on": ", ".join(sorted(faces)),
        "width": listed and bool(abs(wide / listed - 1) <= NEAR_WIDTH),
        "width_m": round(wide, 2),
        "listed_m": listed and round(listed, 2),
    }


def neighbours_of(
    lot: str, paired: set[str], wrong: Mapping[str, Mapping[str, list[str]]]
) -> Told:
    """Tell whether a lot stands beside those that it was seen beside."""
    told = [words for mark in LAWS for words in wrong[mark].get(lot, [])]
    marks = {mark: lot not in wrong[mark] if lot in paired else None for mark in LAWS}
    return {**marks, "beside": "; ".join(told)}


def height_of(one: Told, tall: Told) -> Told:
    """Tell whether a building, and its interval, are as high as counted storeys."""
    counted = tall.get("kind") == heights.COUNTED
    return {
        "height": tall["near"] if counted else None,
        "interval": tall["held"] if counted else None,
        "height_low_m": tall.get("height_low_m"),
        "height_high_m": tall.get("height_high_m"),
        "height_m": round(one["height_m"], 2),
        "counted_m": tall.get("true_m"),
    }


def same_side(left: Stretch, right: Stretch) -> bool:
    """Tell whether two buildings border one side of a ring."""
    return (left.ring, left.side) == (right.ring, right.side)


def from_left(left: Stretch, right: Stretch) -> bool:
    """Tell whether two on one side stand as they were seen, left to right."""
    middles = (left.from_m + left.to_m, right.from_m + right.to_m)
    return not same_side(left, right) or middles[0] < middles[1]


LAWS: Final[Mapping[str, Law]] = {"side": same_side, "order": from_left}


def strangers(
    pairs: Mapping[Pair, Sequence[str]],
    beside: Mapping[str, Sequence[Stretch]],
    law: Law,
) -> dict[str, list[str]]:
    """Gather, by lot, the seen neighbours whose stretches nowhere obey a law.

    A corner's lot borders several sides; where both border one, that one counts.
    """
    found: dict[str, list[str]] = defaultdict(list)
    for (left, right), photos in pairs.items():
        both = [(a, b) for a in beside.get(left, ()) for b in beside.get(right, ())]
        together = [pair for pair in both if same_side(*pair)] or both
        if both and not any(law(a, b) for a, b in together):
            told = f"{left} left of {right} in {', '.join(photos[:2])}"
            found[left].append(told)
            found[right].append(told)
    return found


def text(report: dict[str, Any]) -> str:
    """Write the report: how many are right, a row a lot, the rings, what overlaps."""
    lines = [f"{'':<10}{'right':>7}{'known':>7}"]
    for mark in MARKS:
        known = [row[mark] for row in report["lots"] if row[mark] is not None]
        lines.append(f"{mark:<10}{sum(known):>7}{len(known):>7}")
    lines += ["", f"{'lot':<12}" + "".join(f"{mark:>9}" for mark in MARKS)]
    lines += [line_of(row) for row in report["lots"]]
    lines.append("")
    for one in report["rings"]:
        after = "no ring" if one["after_m"] is None else f"{one['after_m']:.1f} m open"
        lines.append(f"{one['ring']}: missed by {one['before_m']:.1f} m, now {after}")
    for one in report["overlapping"]:
        a, b = one["buildings"]
        lines.append(f"{a} and {b} stand on one another by {one['area_m2']:.1f} m2")
    if not report["overlapping"]:
        lines.append("no two buildings stand on one another")
    return "\n".join(lines)


def line_of(row: Told) -> str:
    """Write one lot; what is wrong is told in words."""
    words = {None: "-", True: "right", False: "WRONG"}
    told = []
    if row["street"] is False:
        told.append(f"stands on {row['stands_on']}, seen on {row['seen_on']}")
    if row["beside"]:
        told.append(row["beside"])
    if row["width"] is False:
        told.append(f"{row['width_m']:.1f} m wide, listed {row['listed_m']:.1f}")
    if row["height"] is False:
        told.append(f"{row['height_m']:.1f} m high, counted {row['counted_m']:.1f}")
    if row["interval"] is False:
        low, high = row["height_low_m"], row["height_high_m"]
        stated = "no interval" if low is None else f"{low:.1f} to {high:.1f} m stated"
        told.append(f"{stated}, counted {row['counted_m']:.1f}")
    marks = "".join(f"{words[row[mark]]:>9}" for mark in MARKS)
    return f"{row['building']:<12}{marks}  {'; '.join(told)}".rstrip()
