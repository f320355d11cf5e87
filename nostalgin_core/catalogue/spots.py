"""Lots on streets, before they have a place in a ring."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from nostalgin_core.address import house_numbers
from nostalgin_core.catalogue.entry import Entry


@dataclass(frozen=True, slots=True)
class Spot:
    """One lot on one street, before it has its place in a ring."""

    block: str
    lot: str
    street: str
    address: str
    width_m: float | None
    depth_m: float | None
    ring: int | None
    side: int | None
    order: float | None
    key: float  # along the block, by lot
    number: float | None  # house number, the middle of a range
    parity: int | None  # 1: odd, 0: even


def spots(rows: Sequence[Entry]) -> list[Spot]:
    """Merge the rows of one block that are about the same lot on the same street."""
    merged: dict[tuple[str, str], Spot] = {}
    for position, row in enumerate(rows):
        name = (row.lot, folded(row.street))
        numbers = house_numbers(row.address)
        spot = Spot(
            block=row.block,
            lot=row.lot,
            street=row.street,
            address=row.address,
            width_m=row.width_m,
            depth_m=row.depth_m,
            ring=row.ring,
            side=row.side,
            order=row.order,
            key=lot_key(row.lot, position) if row.order is None else row.order,
            number=None if numbers is None else sum(numbers) / 2,
            parity=None if numbers is None else numbers[0] % 2,
        )
        known = merged.get(name)
        merged[name] = spot if known is None else _joined(known, spot)
    return sorted(merged.values(), key=lambda spot: spot.key)


def _joined(first: Spot, second: Spot) -> Spot:
    """Keep what the first row says, and what only the second does."""
    empty = {
        name: getattr(second, name)
        for name in ("address", "width_m", "depth_m", "ring", "side", "order")
        if getattr(first, name) in (None, "")
    }
    if first.number is None:
        empty |= {"number": second.number, "parity": second.parity}
    return replace(first, **empty)


def folded(street: str) -> str:
    """Write a street's name as it is compared."""
    return street.casefold().strip(" .")


def lot_key(lot: str, position: int) -> float:
    """Tell where along the block a lot lies; lots that are no numbers go by row."""
    if not lot.isdecimal():
        return float(position)
    number = int(lot)
    return number % 100 + 0.5 if 100 < number < 200 else float(number)
