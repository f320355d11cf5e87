"""Lots on streets, before they have a place in a ring."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

from nostalgin_core.address import house_numbers, plain_name
from nostalgin_core.catalogue.doubt import Doubt
from nostalgin_core.catalogue.entry import Entry

HALF: Final = re.compile(r"\d\s*(?:1/2|½)")
SPLIT_FROM, SPLIT_TO = 100, 200  # between, a lot was split from one below 100
DENSE: Final = 90  # lots that reach it go on beyond a hundred


@dataclass(frozen=True, slots=True)
class Spot:
    """One lot on one street, before it has its place in a ring."""

    block: str
    lot: str
    street: str  # where it is believed to stand; at first, as it is listed
    address: str
    width_m: float | None
    depth_m: float | None
    storeys: float | None
    ring: int | None
    side: int | None
    order: float | None
    key: float  # along the block, by lot
    split: bool  # a later split of another lot: its key is a hint
    numbers: tuple[float, float] | None  # house numbers that are believed
    row: int  # the first that tells of it
    rows: int  # how many do
    listed: str  # the street as it is listed

    @property
    def number(self) -> float | None:
        """The house number, the middle of a range."""
        return None if self.numbers is None else sum(self.numbers) / 2

    @property
    def parity(self) -> int | None:
        """1: odd, 0: even; 33 1/2 is odd."""
        return None if self.numbers is None else int(self.numbers[0]) % 2

    @property
    def place(self) -> str:
        """Number and street as they are listed; "" if neither is."""
        return " ".join(word for word in (self.address, self.listed) if word)

    def told(self) -> str:
        """Name the lot as a person looks for it."""
        return f"lot {self.lot} ({self.place or 'no address'})"


def spots(rows: Sequence[Entry]) -> tuple[list[Spot], list[Doubt]]:
    """Merge the rows of one block that are about the same lot on the same street.

    Of two house numbers the first counts, and the doubt is told.
    """
    merged: dict[tuple[str, str], Spot] = {}
    doubts = []
    dense = _dense(rows)
    for position, row in enumerate(rows):
        name = (row.lot, folded(row.street))
        spot = _spot(row, position, dense=dense)
        known = merged.get(name)
        if known and known.numbers and spot.numbers not in (None, known.numbers):
            text = (
                f"block {row.block}, lot {row.lot}: row {known.row} says "
                f"{known.address} {known.street}, row {row.row} says {row.address}; "
                "the first counts; mend one, or the lot of one"
            )
            doubts.append(Doubt(text, row.block, row.lot, (known.row, row.row)))
        merged[name] = spot if known is None else _joined(known, spot)
    return _in_walk(sorted(merged.values(), key=lambda spot: spot.key)), doubts


def _spot(row: Entry, position: int, *, dense: bool) -> Spot:
    key, split = lot_key(row.lot, position, dense=dense)
    return Spot(
        block=row.block,
        lot=row.lot,
        street=row.street,
        address=row.address,
        width_m=row.width_m,
        depth_m=row.depth_m,
        storeys=row.storeys,
        ring=row.ring,
        side=row.side,
        order=row.order,
        key=key if row.order is None else row.order,
        split=split and row.order is None,
        numbers=numbers_of(row.address),
        row=row.row,
        rows=1,
        listed=row.street,
    )


def _joined(first: Spot, second: Spot) -> Spot:
    """Keep what the first row says, and what only the second does."""
    empty = {
        name: getattr(second, name)
        for name in (
            *("address", "width_m", "depth_m", "storeys"),
            *("ring", "side", "order"),
        )
        if getattr(first, name) in (None, "")
    }
    if first.numbers is None:
        empty |= {"numbers": second.numbers}
    return replace(first, rows=first.rows + 1, **empty)


def _in_walk(some: list[Spot]) -> list[Spot]:
    """Put a corner lot's two streets in the order in which the lots reach them."""
    for place in range(1, len(some)):
        a, b = some[place - 1], some[place]
        if a.lot != b.lot:
            continue
        before, after = some[place - 2], some[(place + 1) % len(some)]
        ends = folded(before.street) == folded(b.street)
        begins = folded(after.street) == folded(a.street)
        apart = folded(before.street) != folded(a.street)
        if (ends or begins) and apart:
            some[place - 1], some[place] = b, a
    return some


def numbers_of(address: str) -> tuple[float, float] | None:
    """Read the house numbers of an address; 33 1/2 stands between 33 and 35."""
    numbers = house_numbers(address)
    if numbers is None:
        return None
    half = 0.5 if numbers[0] == numbers[1] and HALF.search(address) else 0.0
    return float(numbers[0]) + half, float(numbers[1]) + half


def folded(street: str) -> str:
    """Write a street's name as it is compared."""
    return plain_name(street)


def family(street: str) -> str:
    """Name what parallel streets of a numbered grid have in common: West # Street."""
    found = re.sub(r"\d+(?:st|nd|rd|th)?", "#", folded(street))
    return found if "#" in found else ""


def lot_key(lot: str, position: int, *, dense: bool = False) -> tuple[float, bool]:
    """Tell where along the block a lot lies, and whether it was split from another.

    Letters follow their number (12A comes after 12); lots that begin with no number go
    by row. In a block whose lots are `dense` none above a hundred is a split.
    """
    found = re.match(r"(\d{1,9})(?!\d)(.*)", lot)
    if found is None:
        return float(position), False
    number = int(found[1])
    if SPLIT_FROM < number < SPLIT_TO and not dense:
        return number % 100 + 0.5, True
    letters = found[2].strip(" -").casefold()
    return number + (min(ord(letters[0]) - 96, 26) / 100 if letters else 0.0), False


def _dense(rows: Sequence[Entry]) -> bool:
    """Tell whether a block has so many lots that they are counted beyond a hundred."""
    lots = {int(row.lot) for row in rows if row.lot.isdecimal() and len(row.lot) < 4}
    many = [lot for lot in lots if DENSE <= lot <= SPLIT_FROM or lot >= SPLIT_TO]
    return len(many) > 1  # one may be a slip
