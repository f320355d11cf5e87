"""What is told of doubtful lots: why, as what each is taken, the likeliest corrections.

These are another street of the block where the number has its gap, and another number
on the lot's own street: the one that lies between its neighbours' and is most easily
mistaken for what is written. No number is told to two lots: it goes to the one whose
own is most easily mistaken for it.
"""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from nostalgin_core.catalogue.along import Along
from nostalgin_core.catalogue.doubt import Doubt
from nostalgin_core.catalogue.faces import WITNESSES, Faces
from nostalgin_core.catalogue.spots import Spot, folded, numbers_of

REACH: Final = 20  # numbers beyond the last lot of a side
MOST: Final = 3  # streets


def told(
    doubts: Iterable[tuple[Spot, str]], sides: Sequence[Along], known: Faces
) -> list[Doubt]:
    """Tell of each doubtful lot, its reasons joined, in the order of lots.

    It names the list's row, and the street on which the lot is taken to stand.
    """
    reasons: dict[tuple[str, str], tuple[Spot, list[str]]] = {}
    for spot, why in doubts:
        reasons.setdefault((spot.lot, spot.listed), (spot, []))[1].append(why)
    where = {one.lot: (side, i) for side in sides for i, one in enumerate(side.spots)}
    streets: dict[str, list[str]] = defaultdict(list)
    for one in (one for side in sides for one in side.spots):
        streets[one.lot].append(one.street)
    found = []
    doubtful = sorted(reasons.values(), key=lambda one: (one[0].key, one[0].lot))
    numbers = _numbers([spot for spot, _ in doubtful], where, known)
    for (spot, why), number in zip(doubtful, numbers, strict=True):
        likely = _likely(spot, number, known)
        some = "; ".join(dict.fromkeys([*why, *_taken(spot, streets[spot.lot])]))
        remedy = f"; likeliest {' or '.join(likely)}" if likely else ""
        words = f"row {spot.row}: {some}; mend row {spot.row} if it is wrong{remedy}"
        found.append(
            Doubt(
                f"block {spot.block}, {spot.told()}: {words}",
                block=spot.block,
                lot=spot.lot,
                rows=(spot.row,),
                address=spot.place,
                likely=tuple(likely),
            )
        )
    return found


def _taken(spot: Spot, streets: Sequence[str]) -> list[str]:
    """Say on which street a lot is placed, if its row names one."""
    if not spot.listed or not streets:
        return []
    if folded(spot.listed) in map(folded, streets):
        return ["it is left as written"]
    return [f"it is taken as on {' and '.join(dict.fromkeys(streets))}"]


def _numbers(
    doubtful: Sequence[Spot], where: Mapping[str, tuple[Along, int]], known: Faces
) -> list[str]:
    """Give each lot a number and its own street, where one is vacant; "": none is."""
    wishes: list[tuple[int, int, int]] = []  # how far from what is written, whose
    streets: dict[int, str] = {}
    for index, spot in enumerate(doubtful):
        if spot.lot in where:
            side, place = where[spot.lot]
            streets[index] = side.spots[place].street
            written = "".join(c for c in spot.address.split("-")[0] if c.isdecimal())
            vacant = _between(side, place, known) if streets[index] else []
            wishes += [(_mistaken(written, str(n)), n, index) for n in vacant]
    told, given = [""] * len(doubtful), set[tuple[str, int]]()
    for _, number, index in sorted(wishes):
        if not told[index] and (folded(streets[index]), number) not in given:
            told[index] = f"{number} {streets[index]}"
            given.add((folded(streets[index]), number))
    return told


def _likely(spot: Spot, number: str, known: Faces) -> list[str]:
    """List the likeliest corrections of a lot's address."""
    likely = []
    numbers = numbers_of(spot.address)
    if numbers:
        streets = [
            street
            for street in known.frequent
            if folded(street) != folded(spot.listed)
            and known.fits(street, numbers, -1)
            and known.near(street, numbers, -1) == WITNESSES
        ]
        likely += [f"{spot.address} {street}" for street in streets[:MOST]]
    return list(dict.fromkeys([*likely, *filter(None, [number])]))


def _between(side: Along, place: int, known: Faces) -> list[int]:
    """List the numbers between a lot's neighbours that no lot has."""
    run = side.run(1)
    out = {side.steady[i] for i in run.out}
    sure = [i for i in side.steady if i not in out and i != place]
    before = [side.spots[i] for i in sure if i < place][-1:]
    after = [side.spots[i] for i in sure if i > place][:1]
    ends = sorted(one.number or 0.0 for one in (*before, *after))
    if not ends:
        return []
    low, high = int(ends[0]), int(ends[-1])
    if len(ends) == 1:
        rising = run.direction * (1 if before else -1)
        low, high = (low, low + REACH) if rising >= 0 else (max(low - REACH, 0), low)
    street = side.spots[place].street
    return [
        number
        for number in range(low + 1, high)
        if number % 2 == (side.parity if side.parity is not None else number % 2)
        and not known.taken(street, (float(number), float(number)), -1)
    ]


def _mistaken(a: str, b: str) -> int:
    """Count the digits by which two numbers differ; two that are swapped count one."""
    if len(a) != len(b):
        return 9
    differing = [i for i in range(len(a)) if a[i] != b[i]]
    if (
        len(differing) == 2
        and sorted(a) == sorted(b)
        and differing[1] - differing[0] == 1
    ):
        return 1
    return len(differing)
