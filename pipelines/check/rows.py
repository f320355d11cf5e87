"""What can be told from a manifest's rows alone, without one file being looked at."""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from math import exp, log
from statistics import median
from typing import Final

from nostalgin_core.address import house_numbers, plain_name
from nostalgin_core.catalogue import Naming
from pipelines.check.finding import Finding
from pipelines.index.row import CSV, Row

FEW: Final = 5  # widths of a block, from which an outlier can be told
FAR: Final = 3.5  # robust standard deviations (Iglewicz and Hoaglin, 1993)
LEAST_SD: Final = 0.15  # of the logarithm of a block's widths: lots are much alike
TO_SD: Final = 1.4826  # from the median absolute deviation of a normal distribution


def keys(rows: Sequence[Row], naming: Naming) -> Iterator[Finding]:
    """Find photographs without a place, or with another than their names tell."""
    places: dict[tuple[str, str, str], Row] = {}
    for row in rows:
        front = row.front
        if front is None:
            remedy = f"fill in front_id, block and lot of {row.photo}"
            yield Finding("no front", row.key, row.photo, remedy, grave=True)
            continue
        told = naming.told(row.photo) if row.photo else None
        if told is not None and told != (front.block, front.lot):
            words = f"{row.photo} by its name is of {told[0]}-{told[1]}"
            remedy = f"mend the lot ({front.block}-{front.lot}) or the photo"
            yield Finding("other lot by its name", row.key, words, remedy, grave=False)
        where = (front.block, plain_name(front.street), front.address.casefold())
        first = places.setdefault(where, row)
        if front.address and first.front and first.front.lot != front.lot:
            words = f"{front.address} {front.street} is of lot {first.front.lot}"
            words += f" ({first.key}) and of lot {front.lot}"
            remedy = "mend the address of one of them"
            yield Finding("address of two lots", row.key, words, remedy, grave=False)


def rights(rows: Sequence[Row]) -> Iterator[Finding]:
    """Find photographs of which nobody says whose they are, each once."""
    silent: dict[tuple[str, str], Row] = {}
    said: set[tuple[str, str]] = set()
    for row in rows:
        name = (row.root, row.photo)
        if row.credit or row.told.keys() & {"rights", "license"}:
            said.add(name)
        elif row.photo:
            silent.setdefault(name, row)
    for name, row in silent.items():
        if name not in said:
            remedy = "fill in credit, rights or license, or index with --credit"
            yield Finding("rights missing", row.key, row.photo, remedy, grave=False)


def streets(rows: Sequence[Row]) -> Iterator[Finding]:
    """Find streets on which no front of a block has a number: what sets their order?"""
    numbered: dict[tuple[str, str], list[bool]] = defaultdict(list)
    first: dict[tuple[str, str], Row] = {}
    for row in rows:
        if row.front is not None:
            where = (row.front.block, row.front.street)
            first.setdefault(where, row)
            numbered[where].append(house_numbers(row.front.address) is not None)
    for (block, street), some in numbered.items():
        if any(some):
            continue
        row = first[block, street]
        words = f"block {block}: {len(some)} rows on {street or 'no street'}"
        remedy = "fill in street and address, or order by corrections"
        yield Finding("street without numbers", row.key, words, remedy, grave=False)


def widths(rows: Sequence[Row]) -> Iterator[Finding]:
    """Find widths that are quite unlike those of their block."""
    known: dict[str, dict[str, tuple[Row, float]]] = defaultdict(dict)
    for row in rows:
        if row.front is not None and not row.front.width_assumed:
            own = known[row.front.block]
            own.setdefault(row.front.front_id, (row, row.front.width_m))
    for own in known.values():
        if len(own) < FEW:
            continue
        logs = {one: log(w) for one, (_, w) in own.items()}
        middle = median(logs.values())
        sd = max(TO_SD * median(abs(v - middle) for v in logs.values()), LEAST_SD)
        for one, (row, width_m) in own.items():
            if abs(logs[one] - middle) > FAR * sd:
                usual = exp(middle)
                words = f"{one} is {width_m:g} m wide, its block's {usual:.1f}"
                remedy = "measure it; mend width_m, or correct it"
                yield Finding("width far out", row.key, words, remedy, grave=False)


def schema(found: Sequence[str]) -> Iterator[Finding]:
    """Tell what the manifest's reading warned of."""
    for warning in found:
        row, _, words = warning.partition(": ")
        if not words:
            row, words = CSV, warning
        remedy = "see docs/manifest.md"
        yield Finding("contradiction", row, words, remedy, grave=False)
