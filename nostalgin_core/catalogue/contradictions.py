"""Rows that say twice the same, or otherwise than the name of their own photograph."""

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final

from nostalgin_core.address import house_numbers
from nostalgin_core.catalogue.doubt import Doubt
from nostalgin_core.catalogue.entry import Entry, Named, from_file_name

WIDEST: Final = 60  # numbers of one lot: thirty doors
FAR: Final = 20  # numbers to the next lot: ten doors, where others stand close
FARTHER: Final = 3  # times any gap between the others
LEAST_OTHERS: Final = 4  # lots of a side: fewer do not tell how close they stand


def contradictions(
    rows: Sequence[Entry], *, named: Named = from_file_name
) -> Iterator[Doubt]:
    """Name the rows of one block that were written twice, or for another lot's photo.

    A photo's name tells its lot only in an archive that names its files so.
    """
    yield from _odd_ranges(rows)
    yield from _far_off(rows)
    seen: dict[tuple[str, ...], int] = {}
    for row in rows:
        says = (row.photo, row.lot, row.street, row.address)
        first = seen.setdefault(says, row.row)
        if first != row.row:
            text = (
                f"block {row.block}, lot {row.lot}: row {first} and row {row.row} say "
                "the same; delete one of them"
            )
            yield Doubt(text, row.block, row.lot, (first, row.row))
        told = named(row.photo)
        if told is not None and told != (row.block, row.lot):
            text = (
                f"block {row.block}, lot {row.lot}: row {row.row} names {row.photo}, "
                f"by its name a photo of block {told[0]}, lot {told[1]}; mend the "
                "lot or the photo"
            )
            where = (row.block, row.lot, (row.row,))
            yield Doubt(text, *where, photo=row.photo, named=told)


def _odd_ranges(rows: Sequence[Entry]) -> Iterator[Doubt]:
    """Name the house numbers that fall, pass to the other side, or run too far."""
    told: set[tuple[str, str]] = set()
    for row in rows:
        ends = house_numbers(row.address)
        if ends is None or ends[0] == ends[1] or (row.lot, row.address) in told:
            continue
        why = ""
        if not re.match(rf"\D*{ends[0]}(?!\d)", row.address):
            why = "falls"
        elif (ends[1] - ends[0]) % 2:
            why = "has an odd end and an even one"
        elif ends[1] - ends[0] > WIDEST:
            why = "is too wide for one lot"
        if why:
            told.add((row.lot, row.address))
            text = (
                f"block {row.block}, lot {row.lot}: row {row.row} says {row.address}, "
                f"a range that {why}; mend the number"
            )
            yield Doubt(text, row.block, row.lot, (row.row,))


def _far_off(rows: Sequence[Entry]) -> Iterator[Doubt]:
    """Name the lots whose number is far from all others of its side of the street."""
    sides: dict[tuple[str, int], dict[str, tuple[int, int, Entry]]] = {}
    for row in rows:
        ends = house_numbers(row.address)
        if ends is not None and (ends[1] - ends[0]) % 2 == 0 and ends[0] <= ends[1]:
            side = sides.setdefault((row.street.casefold(), ends[0] % 2), {})
            side.setdefault(row.lot, (*ends, row))
    for side in sides.values():
        for lot, (low, high, row) in side.items():
            others = sorted(side[other][:2] for other in side if other != lot)
            if len(others) < LEAST_OTHERS:
                continue
            gap = min(max(a - high, low - b) for a, b in others)
            between = (b[0] - a[1] for a, b in pairwise(others))
            if gap > max(FAR, FARTHER * max(between)):
                text = (
                    f"block {row.block}, lot {lot}: row {row.row} says {row.address}, "
                    f"{gap} numbers from the next lot of its side; mend the number"
                )
                yield Doubt(text, row.block, lot, (row.row,))
