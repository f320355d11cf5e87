"""Whether photographs without names lead to fronts in their order along the streets.

The archive's own list is hidden among decoys on other blocks, and names no file. What
`index` makes of it by the boards alone is compared with the addresses of the list.
"""

import csv
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

from nostalgin_core import catalogue
from nostalgin_core.measure import order
from nostalgin_core.placard import Key
from pipelines.index import manifest
from pipelines.store import Store

LIST: Final = "catalogue.csv"
FILE: Final = "File Name"  # the column that names files
BLOCK, LOT = "1940 Block Number", "1940 Lot Number"


def hidden(listed: Path, keys: Sequence[Key]) -> tuple[list[str], list[list[str]]]:
    """Give a list without its files' names, and with keys of other blocks among it."""
    rows = read(listed)
    blocks = {row[BLOCK] for row in rows}
    names = [name for name in rows[0] if name.strip() != FILE]
    decoys = [{BLOCK: block, LOT: lot} for block, lot in keys if block not in blocks]
    both = sorted([*rows, *decoys], key=lambda row: (row[BLOCK], row[LOT]))
    return names, [[row.get(name, "") for name in names] for row in both]


def judged(city: Path, listed: Path) -> dict[str, Any]:
    """Compare the order of a manifest's fronts with the addresses of the true list."""
    entries = catalogue.read(read(listed)).entries
    addresses: dict[Key, list[str]] = defaultdict(list)
    for one in entries:
        addresses[one.block, one.lot].append(f"{one.address} {one.street}")
    rows = manifest.read(Store(str(city))).rows
    every = {row.front.front_id: row.front for row in rows if row.front}
    true = {one.block for one in entries}
    fronts = [one for one in every.values() if one.block in true]
    streets = order.opposite(order.sides(fronts, addresses))
    blocks = [asdict(one) for one in order.orders(fronts, addresses)]
    return {"blocks": blocks, "opposite": streets[0], "streets": streets[1]}


def read(listed: Path) -> list[dict[str, str]]:
    """Read the archive's list."""
    with listed.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def lines(report: dict[str, Any]) -> list[str]:
    """Write a line a block."""
    told = []
    for one in report["blocks"]:
        which = f"block {one['block']} ({one['rings']} rings)"
        wrong = f", not {', '.join(one['wrong'])}" if one["wrong"] else ""
        silent = f"; {one['unnumbered']} without a number" * (one["unnumbered"] > 0)
        share = f"order right in {one['right']} of {one['lots']}"
        told.append(f"{which}: {share}{wrong}{silent}")
    words = "streets with both sides: these run opposite in"
    return [*told, f"{words} {report['opposite']} of {report['streets']}"]
