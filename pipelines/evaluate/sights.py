"""What people read off photographs of known lots: faces, neighbours, who stands left.

`storeys.csv` says in `faces` which streets a lot's front looks on, with semicolons.
`lots.json` says which lot each labelled front of a photograph is (`lot`, `also` for
others under one outline), on which street (`front`) and how surely (`sure`, 0 a guess);
`labels/ID.json` says where in the picture.
"""

import csv
import json
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from statistics import mean
from typing import Any, Final

from nostalgin_core.address import plain_name
from nostalgin_core.catalogue import from_file_name
from pipelines.evaluate import Unmeasurable, labels

LEAST_SURE: Final = 1  # of lots.json: by order at least

Pair = tuple[str, str]  # the left lot and the right one, as block-lot


@dataclass(frozen=True, slots=True)
class Sights:
    """What is seen, by lot (`993-5`)."""

    faces: Mapping[str, frozenset[str]]  # streets, casefolded
    pairs: Mapping[Pair, tuple[str, ...]]  # on one street, and the photos that show it


def sights(data: Path) -> Sights:
    """Read what can be seen in a folder of labelled photographs.

    Raises:
        Unmeasurable: if a file is not there or makes no sense.
    """
    try:
        lots = json.loads((data / "lots.json").read_text(encoding="utf-8"))
        with (data / "storeys.csv").open(encoding="utf-8-sig", newline="") as file:
            rows = list(csv.DictReader(file))
    except (OSError, ValueError) as problem:
        raise Unmeasurable(f"{data}: lots.json and storeys.csv: {problem}") from problem
    pairs: dict[Pair, list[str]] = defaultdict(list)
    for photo, fronts in sorted(lots.items()):
        drawn = labels.read(data / "labels" / f"{photo}.json")["objects"]
        for pair in in_order(fronts, drawn):
            pairs[pair].append(photo)
    return Sights(faced(rows), {pair: tuple(pairs[pair]) for pair in sorted(pairs)})


def faced(rows: Sequence[Mapping[str, str]]) -> dict[str, frozenset[str]]:
    """Gather the streets that each lot's front was seen to look on."""
    faces: dict[str, frozenset[str]] = {}
    for row in rows:
        lot = from_file_name(row.get("id") or "")
        if lot is not None:
            names = (row.get("faces") or "").split(";")
            own = frozenset(plain_name(name) for name in names if name.strip())
            faces["-".join(lot)] = faces.get("-".join(lot), frozenset()) | own
    return faces


def in_order(
    fronts: Sequence[Mapping[str, Any]], drawn: Sequence[Mapping[str, Any]]
) -> list[Pair]:
    """Pair each front of a photograph with the next to its right on the same street.

    Between two that are paired stands no other labelled front of that street. An
    outline of several lots tells nothing of their order.
    """
    streets: dict[str, list[tuple[float, str]]] = defaultdict(list)
    for one in fronts:
        if one.get("front"):
            x = mean(point[0] for point in drawn[one["object"]]["polygon"])
            alone = one["lot"] and not one.get("also") and one["sure"] >= LEAST_SURE
            streets[one["front"]].append((x, one["lot"] if alone else ""))
    return [
        (left, right)
        for those in streets.values()
        for (_, left), (_, right) in pairwise(sorted(those))
        if left and right and left != right
    ]
