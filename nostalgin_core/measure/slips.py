"""One slip of a list moves one lot: every slip of every row, and what it moved.

A slip spoils one cell of one row, or adds or loses that row, as a clerk might. The city
is laid out from the spoilt list, and every front of the same block that the slip is not
about is compared with the sound layout. A front *keeps its side* if it stands on the
same ring and side; where a ring was begun at another corner, its sides are counted from
there. It *keeps its order* if the next of those fronts round its ring is the same.
A slip is *named* if something new is told of its row or lot. What is new and names only
lots that no slip is about counts as a *false alarm*.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from nostalgin_core.address import house_numbers
from nostalgin_core.catalogue import Entry, from_file_name
from nostalgin_core.records import Front

KINDS: Final = (
    *("wrong street", "wrong number", "other parity", "swapped digits"),
    *("missing", "doubled", "neighbour's photograph", "wrong lot"),
)
ELSEWHERE: Final = "Quai des Orfevres"  # a street of no block that is measured

Layout = Callable[[Sequence[Entry]], tuple[Sequence[Front], Sequence[str]]]
Name = tuple[str, str, str]  # block, lot, street
Place = tuple[int, int, int]  # ring, side, rank


@dataclass(frozen=True, slots=True)
class Slip:
    """One slip: the spoilt list, and whom it is about."""

    kind: str
    told: str  # what was done, in words
    row: int
    block: str
    lots: frozenset[str]  # that the slip is about
    entries: tuple[Entry, ...]


@dataclass(frozen=True, slots=True)
class Outcome:
    """What one slip moved of the other fronts of its block."""

    slip: Slip
    fronts: int
    sides_kept: int
    orders_kept: int
    named: bool
    false_alarms: tuple[str, ...]


def outcomes(entries: Sequence[Entry], layout: Layout) -> Iterator[Outcome]:
    """Lay the city out again for every slip of every row, and compare."""
    sound, told = layout(entries)
    blocks = placed(sound)
    for slip in slips(entries):
        fronts, doubts = layout(slip.entries)
        new = sorted(set(doubts) - set(told))
        before = without(blocks.get(slip.block, {}), slip.lots)
        after = without(placed(fronts).get(slip.block, {}), slip.lots)
        about = [each for each in new if names(each, slip)]
        yield Outcome(
            slip=slip,
            fronts=len(before),
            sides_kept=len(sides_kept(before, after)),
            orders_kept=orders_kept(before, after),
            named=bool(about),
            false_alarms=tuple(each for each in new if each not in about),
        )


def slips(entries: Sequence[Entry]) -> Iterator[Slip]:
    """List every kind of slip of every row; what is chosen by lot is chosen by row."""
    rows = list(entries)
    streets: dict[str, dict[str, None]] = defaultdict(dict)
    for entry in rows:
        if entry.street:
            streets[entry.block][entry.street] = None
    for place, entry in enumerate(rows):
        rng = np.random.default_rng([entry.row, place])
        following = _next(rows, place)
        spoilt = [
            *_streets(entry, list(streets[entry.block])),
            *_numbers(entry, following, rng),
            *_missing(entry),
            *_wrong_lots(entry),
        ]
        for kind, words, cells in spoilt:
            new = [*rows[:place], *cells, *rows[place + 1 :]]
            lots = frozenset({entry.lot, *(cell.lot for cell in cells)})
            yield Slip(kind, words, entry.row, entry.block, lots, tuple(new))
        yield from _with_another(rows, place, following)


def _next(rows: Sequence[Entry], place: int) -> Entry | None:
    """Find the next row of another lot of the block, or else the first."""
    own = rows[place]
    others = [*rows[place + 1 :], *rows[:place]]
    return next((e for e in others if e.block == own.block and e.lot != own.lot), None)


Spoilt = Iterator[tuple[str, str, tuple[Entry, ...]]]


def _streets(entry: Entry, streets: Sequence[str]) -> Spoilt:
    for street in [*streets, ELSEWHERE]:
        if street.casefold() != entry.street.casefold():
            yield "wrong street", street, (replace(entry, street=street),)


def _numbers(entry: Entry, following: Entry | None, rng: np.random.Generator) -> Spoilt:
    """Spoil a house number: by a few doors, a digit, a neighbour's, one, or a swap."""
    numbers = house_numbers(entry.address)
    if numbers is None:
        return
    written = entry.address
    doors = 2 * int(rng.integers(1, 20)) * int(rng.choice([-1, 1]))
    wrong = [_shifted(written, doors), _misread(written, rng)]
    wrong += [following.address] if following and following.address else []
    swapped = [
        f"{written[:i]}{written[i + 1]}{written[i]}{written[i + 2 :]}"
        for i in range(len(written) - 1)
        if written[i : i + 2].isdecimal() and written[i] != written[i + 1]
    ]
    parity = [_shifted(written, step) for step in (-1, 1)]
    for kind, addresses in (
        ("wrong number", wrong),
        ("other parity", parity),
        ("swapped digits", swapped),
    ):
        for address in addresses:
            if address != written:
                yield kind, address, (replace(entry, address=address),)


def _shifted(address: str, doors: int) -> str:
    """Add to both ends of a range."""

    def added(found: re.Match[str]) -> str:
        return str(max(int(found[0]) + doors, 1))

    return re.sub(r"(?<![/\d])\d+(?![/\d])", added, address)


def _misread(address: str, rng: np.random.Generator) -> str:
    """Take one digit of the first number but the last for another."""
    found = re.search(r"\d+", address)
    if found is None or len(found[0]) < 2:
        return address
    place = found.start() + int(rng.integers(len(found[0]) - 1))
    other = (int(address[place]) + int(rng.integers(1, 10))) % 10
    return f"{address[:place]}{other}{address[place + 1 :]}"


def _missing(entry: Entry) -> Spoilt:
    if entry.address:
        yield "missing", "no number", (replace(entry, address=""),)
    if entry.street:
        yield "missing", "no street", (replace(entry, street=""),)
    yield "missing", "no row", ()


def _wrong_lots(entry: Entry) -> Spoilt:
    """Swap the last digits of a lot; a lot of one digit gets another one before it."""
    lot = entry.lot
    if not lot.isdecimal():
        return
    swapped = f"{lot[:-2]}{lot[-1]}{lot[-2]}" if len(lot) > 1 else f"1{lot}"
    swapped = swapped.lstrip("0") or lot
    if swapped != lot:
        yield "wrong lot", swapped, (replace(entry, lot=swapped),)


def _with_another(
    rows: Sequence[Entry], place: int, following: Entry | None
) -> Iterator[Slip]:
    """List the slips that take a row for another one."""
    entry = rows[place]
    rest = [*rows[:place], *rows[place + 1 :]]
    again = replace(entry, row=max(row.row for row in rows) + 1)
    twice = (*rows[: place + 1], again, *rows[place + 1 :])
    own = frozenset({entry.lot})
    yield Slip("doubled", "the row", entry.row, entry.block, own, twice)
    if following is None:
        return
    both = frozenset({entry.lot, following.lot})
    copied = replace(entry, lot=following.lot)
    for words, new in (
        ("under the next lot as well", (*rows[:place], copied, *rows[place:])),
        ("under the next lot", (*rest[:place], copied, *rest[place:])),
    ):
        yield Slip("doubled", words, entry.row, entry.block, both, new)
    shown = replace(entry, photo=following.photo)
    new = (*rest[:place], shown, *rest[place:])
    words = f"shows {following.lot}"
    yield Slip("neighbour's photograph", words, entry.row, entry.block, own, new)


def placed(fronts: Sequence[Front]) -> dict[str, dict[Name, Place]]:
    """Tell where each front of each block stands; of two on a street, the first."""
    blocks: dict[str, dict[Name, Place]] = defaultdict(dict)
    for front in fronts:
        name = (front.block, front.lot, front.street.casefold())
        blocks[front.block].setdefault(name, (front.ring, front.side, front.rank))
    return blocks


def without(places: Mapping[Name, Place], lots: frozenset[str]) -> dict[Name, Place]:
    """Leave out the fronts of the lots that a slip is about."""
    return {name: place for name, place in places.items() if name[1] not in lots}


def sides_kept(
    before: Mapping[Name, Place], after: Mapping[Name, Place]
) -> frozenset[Name]:
    """Name the fronts whose ring and side are the same.

    A ring is known again by most of its fronts, and its first side by most of them.
    """
    kept: set[Name] = set()
    free = {place[0] for place in after.values()}
    rings = Counter(place[0] for place in before.values())
    for ring, _ in rings.most_common():
        own = [name for name, place in before.items() if place[0] == ring]
        there = Counter(after[n][0] for n in own if n in after and after[n][0] in free)
        if not there:
            continue
        other = there.most_common(1)[0][0]
        free.remove(other)
        count = max(_count(before, ring), _count(after, other))
        turns = Counter(
            (after[name][1] - before[name][1]) % count
            for name in own
            if name in after and after[name][0] == other
        )
        turn = turns.most_common(1)[0][0]
        kept |= {
            name
            for name in own
            if name in after
            and after[name][0] == other
            and (after[name][1] - before[name][1]) % count == turn
        }
    return frozenset(kept)


def _count(places: Mapping[Name, Place], ring: int) -> int:
    """Count the sides of a ring, of which up to one may be empty at its end."""
    sides = {side for at, side, _ in places.values() if at == ring}
    return max(4, max(sides) + 1) if len(sides) > 1 else 1


def orders_kept(before: Mapping[Name, Place], after: Mapping[Name, Place]) -> int:
    """Count the fronts that are followed by the same one."""
    follower, now = followers(before), followers(after)
    return sum(now.get(name) == other for name, other in follower.items())


def followers(places: Mapping[Name, Place]) -> dict[Name, Name]:
    """Tell which front comes after each as one walks round its ring."""
    rings: dict[int, list[tuple[int, Name]]] = defaultdict(list)
    for name, (ring, _, rank) in places.items():
        rings[ring].append((rank, name))
    walks = [[name for _, name in sorted(ring)] for ring in rings.values()]
    return {
        name: after
        for walk in walks
        for name, after in zip(walk, [*walk[1:], *walk[:1]], strict=True)
    }


def names(told: str, slip: Slip) -> bool:
    """Tell whether a doubt is about a slip's row or one of its lots."""
    if re.search(rf"\brow {slip.row}\b", told):
        return True
    files = [from_file_name(word.strip(",;:")) for word in told.split()]
    if any(lot in files for lot in ((slip.block, lot) for lot in slip.lots)):
        return True
    lots = re.findall(r"\blots? ([\w-]+(?:(?: \([^)]*\))?(?:,| and) [\w-]+)*)", told)
    named = {word for some in lots for word in re.findall(r"[\w-]+", some)}
    return (
        bool(named & slip.lots)
        and re.search(rf"\bblock {re.escape(slip.block)}\b", told) is not None
    )
