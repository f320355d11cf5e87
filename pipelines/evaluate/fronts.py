"""How often the facades of a finished city are told to be the right fronts.

A facade's quad is matched to the labelled outline that it covers best; `lots.json` says
which lot that is, and which others are under the same outline: any of them is right. A
claim of a front that is labelled as none of the list's is wrong.
"""

import json
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

import numpy as np
import shapely

from pipelines.evaluate import Unmeasurable, labels
from pipelines.store import Store, runs

COVERED: Final = 0.5  # intersection over union of a facade and its labelled outline
STATED: Final = (0.8, 0.9, 0.95, 0.99, 1.0)
HEAD: Final = ("labelled", "found", "claimed", "right", "share claimed", "share right")

Row = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Shown:
    """A labelled front, the facade found on it, and what that is claimed to be."""

    photo: str
    lots: frozenset[str]  # block-lot; none: no front of the list's
    found: bool
    claim: Row | None

    @property
    def right(self) -> bool:
        """Tell whether the claim names the front's lot."""
        return self.claim is not None and lot_of(self.claim) in self.lots


def evaluate(data: Path, city: Path, *, block: str = "") -> Row:
    """Hold the published run's table of claims against labels.

    Raises:
        Unmeasurable: if nothing tells lots, or there is no run with claims.
    """
    lots = read_lots(data / "lots.json")
    store = Store(str(city))
    try:
        run = runs.shown(store)
        claims = runs.read_table(store, run, "claims")
        facades = runs.read_table(store, run, "facades")
    except (OSError, ValueError) as problem:
        raise Unmeasurable(
            f"{city} has no finished run that tells claims: build it first"
        ) from problem
    shown = list(labelled(data, lots, facades, claims, block=block))
    if not any(one.found for one in shown):
        raise Unmeasurable(f"{city} shows no labelled front of {data}")
    return summed(shown)


def read_lots(path: Path) -> dict[str, list[Row]]:
    """Read which lot each labelled outline is.

    Raises:
        Unmeasurable: if the file can't be read.
    """
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError) as problem:
        raise Unmeasurable(f"{path}: {problem}") from problem


def labelled(
    data: Path,
    lots: dict[str, list[Row]],
    facades: Sequence[Row],
    claims: Sequence[Row],
    *,
    block: str,
) -> Iterator[Shown]:
    """Put each labelled front beside the facade that was found on it."""
    by_name: dict[str, list[Row]] = defaultdict(list)
    for row in facades:
        by_name[Path(row["name"]).name].append(row)
    said = {(row["photo"], row["facade"]): row for row in claims}
    for label, path in labels.pairs(data, block=block):
        known = {each["object"]: each for each in lots.get(label["id"], ())}
        there = by_name.get(path.name, [])
        for number, one in enumerate(label["objects"]):
            if one["category"] != "facade" or one.get("group") or number not in known:
                continue
            whose = known[number]
            every = (whose["lot"], *whose.get("also", ()))
            best = on(one["polygon"], there)
            yield Shown(
                label["id"],
                frozenset(lot for lot in every if lot is not None),
                best is not None,
                None if best is None else said.get((best["photo"], best["facade"])),
            )


def on(polygon: list[list[float]], facades: Sequence[Row]) -> Row | None:
    """Find the facade that covers a labelled outline best, if one does."""
    outline = shapely.Polygon(polygon).buffer(0)
    best, most = None, COVERED
    for row in facades:
        quad = shapely.Polygon(np.reshape(row["quad_px"], (4, 2))).buffer(0)
        seen = quad.intersection(shapely.box(0, 0, *row["size_px"]))
        both = outline.intersection(seen).area
        share = both / max(outline.union(seen).area, 1.0)
        if share >= most:
            best, most = row, share
    return best


def lot_of(claim: Row) -> str:
    """Name the block and lot of a claim."""
    return claim["front_id"].rpartition("-")[0]


def summed(shown: Sequence[Shown]) -> Row:
    """Count by block and by how claims are known; name what is wrong."""
    claims = [one for one in shown if one.claim is not None]
    blocks = sorted({one.photo.partition("_")[0] for one in shown})
    ways = sorted({one.claim["told"] for one in claims if one.claim})
    return {
        "blocks": {
            name: counted([one for one in shown if one.photo.startswith(name)])
            for name in blocks
        },
        "told": {
            way: counted(
                [one for one in claims if one.claim and one.claim["told"] == way]
            )
            for way in ways
        },
        "all": counted(shown),
        "stated": [stated(claims, low, high) for low, high in pairwise(STATED)],
        "wrong": [
            wrong(one, one.claim) for one in claims if one.claim and not one.right
        ],
    }


def counted(shown: Sequence[Shown]) -> Row:
    """Count labelled fronts whose lot is known, those claimed, those claimed right."""
    known = [one for one in shown if one.lots]
    claims = [one for one in shown if one.claim is not None]
    told = sum(one.claim is not None for one in known)
    right = sum(one.right for one in claims)
    return {
        "labelled": len(known),
        "found": sum(one.found for one in known),
        "claimed": len(claims),
        "right": right,
        "share claimed": told / len(known) if known else None,
        "share right": right / len(claims) if claims else None,
    }


def stated(claims: Sequence[Shown], low: float, high: float) -> Row:
    """Compare what was stated of some claims with what is so."""
    some = [
        (one.claim["probability"], one.right)
        for one in claims
        if one.claim
        and (
            low <= one.claim["probability"] < high
            or high == 1.0 <= one.claim["probability"]
        )
    ]
    mean, right = np.mean(some, axis=0) if some else (None, None)
    return {"above": low, "claims": len(some), "stated": mean, "right": right}


def wrong(one: Shown, claim: Row) -> Row:
    """Name a claim that is wrong."""
    names = ("facade", "front_id", "probability", "told")
    is_of = sorted(one.lots) or ["none of the list's"]
    return {"photo": one.photo, "is": is_of, **{n: claim[n] for n in names}}


def text(report: Row) -> str:
    """Write the report: a row a block and a way, calibration, wrong ones by name."""
    rows = {**report["blocks"], "all": report["all"], **report["told"]}
    lines = [f"{'':<12}" + "".join(f"{name:>15}" for name in HEAD)]
    for name, row in rows.items():
        cells = (cell(row[key]) for key in HEAD)
        lines.append(f"{name:<12}" + "".join(cells))
    lines += ["", f"{'stated above':<12}{'claims':>15}{'stated':>15}{'right':>15}"]
    for row in report["stated"]:
        cells = (cell(row[key]) for key in ("claims", "stated", "right"))
        lines.append(f"{row['above']:<12}" + "".join(cells))
    lines += ["", "wrong:" if report["wrong"] else "none is wrong"]
    for row in report["wrong"]:
        lines.append(
            f"  {row['photo']} facade {row['facade']}: {row['front_id']} "
            f"({row['probability']:.2f}, {row['told']}) is {' and '.join(row['is'])}"
        )
    return "\n".join(lines)


def cell(value: float | None) -> str:
    """Write a count or a share."""
    if value is None:
        return f"{'-':>15}"
    return f"{value:>15}" if isinstance(value, int) else f"{value:>15.3f}"
