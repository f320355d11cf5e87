"""How lots stand along one side of a ring, and whose house number does not fit.

Lots run anticlockwise, and house numbers rise or fall with them. Where the two agree on
most of a side, a number that does not is set aside, and its lot stands by its lot
number: so one wrong number moves no lot but its own. Where they do not agree (a list
whose lots are in no order), the numbers alone order the side, by the law of its street
(`directions`). The law also rules the side that has a block's first lots, which often
run against the rest. A lot that was split from another stands by its number.
"""

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from nostalgin_core.catalogue.directions import Law, SideFacts
from nostalgin_core.catalogue.runs import Run, runs
from nostalgin_core.catalogue.sides import usual
from nostalgin_core.catalogue.spots import Spot, folded

AGREEING: Final = 2 / 3  # of a side's numbers, to stand by lot
ASTRAY: Final = 0.25  # of a block's numbers may run against its lots
FEW: Final = 2  # or so many: a slip, and what was odd before
MIXED: Final = 0.25  # of a side's numbers: then both parities stand on it
FAR: Final = 50.0  # numbers: half a front of 800 feet

Doubts = list[tuple[Spot, str]]


@dataclass(frozen=True, slots=True, eq=False)
class Along:
    """One side, its lots in their order, and what their numbers say."""

    spots: list[Spot]  # by lot
    steady: list[int]  # places of lots whose numbers can be ordered
    far: list[int]  # of lots whose numbers are far from all of these
    up: Run  # of the steady ones
    down: Run
    parity: int | None  # None: both stand here, or no number is known

    @property
    def direction(self) -> int:
        """How the numbers run with the lots: 1 rising, -1 falling, 0 untold."""
        return (self.up.length > self.down.length) - (self.up.length < self.down.length)

    def run(self, rising: int) -> Run:
        """Give the longer run; of two as long, the one that the law says."""
        return self.up if (self.direction or rising) > 0 else self.down

    @property
    def agreeing(self) -> bool:
        """Tell whether lots and numbers run together on most of the side."""
        return max(self.up.length, self.down.length) >= AGREEING * len(self.steady)

    @property
    def sign(self) -> int:
        """1 where odd numbers stand, -1 where even ones do."""
        return -1 if self.parity == 0 else 1

    def rising(self, law: Law) -> int:
        """Tell how numbers run anticlockwise by the law of the street."""
        return law.get(folded(self.spots[0].street), 1) * self.sign

    def facts(self, *, first: bool = False) -> SideFacts | None:
        """Tell the street, its parity (1 odd, -1 even), and how its numbers run.

        The side that has a block's first lots speaks with half its voice.
        """
        if not any(one.numbers for one in self.spots):
            return None
        length = max(self.up.length, self.down.length)
        votes = self.direction * length * (length - 1) / (4 if first else 2)
        return folded(self.spots[0].street), self.sign, votes


def along(spots: Sequence[Spot]) -> Along:
    """Find the numbers of a side that can be ordered, and how they run."""
    parity = usual(spots)
    numbered = [i for i, one in enumerate(spots) if one.numbers is not None]
    odd_ones = {i for i in numbered if spots[i].parity != parity}
    if len(odd_ones) > 1 and len(odd_ones) > MIXED * len(numbered):
        parity, odd_ones = None, set()
    fitting = [i for i in numbered if i not in odd_ones]
    far = _far(spots, fitting)
    fitting = [i for i in fitting if i not in far]
    steady = [i for i in fitting if not spots[i].split]
    steady = steady if len(steady) > 1 else fitting
    up, down = runs([spots[i].numbers or (0.0, 0.0) for i in steady])
    return Along(list(spots), steady, far, up, down, parity)


def _far(spots: Sequence[Spot], places: Sequence[int]) -> list[int]:
    """Find the lots whose numbers are far from all others, of three or more."""
    some = sorted((spots[i].numbers or (0.0, 0.0), i) for i in places)
    if len(some) < 3:
        return []
    found = []
    for at, ((low, high), i) in enumerate(some):
        below = low - some[at - 1][0][1] if at else FAR + 1
        above = some[at + 1][0][0] - high if at + 1 < len(some) else FAR + 1
        if min(below, above) > FAR:
            found.append(i)
    return found if 2 * len(found) < len(some) else []


def trusted(sides: Sequence[Along]) -> bool:
    """Tell whether lots and numbers agree on most of a block: then lots can order."""
    count = sum(len(side.steady) for side in sides)
    astray = sum(
        len(side.steady) - max(side.up.length, side.down.length) for side in sides
    )
    named = [one.lot[:1].isdecimal() for side in sides for one in side.spots]
    few = FEW if all(named) else 0  # lots without a number stand as they are listed
    return astray <= max(few, ASTRAY * count)


def ordered(side: Along, law: Law, *, by_lot: bool, first: bool) -> list[Spot]:
    """Order a side anticlockwise; `first` tells that a block's lots begin on it."""
    if not side.steady:
        return side.spots
    rising = side.rising(law)
    unsure = first and not side.agreeing
    if (
        not by_lot
        or unsure
        or (len(side.steady) > 1 and not side.run(rising).length > 1)
    ):
        return _by_number(side.spots, rising)
    made = _with_split(side, side.run(rising))
    return made[::-1] if first and side.direction == -rising else made


def _with_split(side: Along, run: Run) -> list[Spot]:
    """Put lots that were split from others between the numbers that theirs is between.

    Where lots run against the law, so do their numbers.
    """
    runs = run.direction
    own = set(side.steady)
    out = {side.steady[place] for place in (*run.out, *run.doubtful)}
    loose = {
        i for i, one in enumerate(side.spots) if i not in own and _loose(one, side)
    }
    sure = [i for i in side.steady if i not in out]
    numbers = [runs * (side.spots[i].number or 0.0) for i in sure]
    fixed = [i for i in range(len(side.spots)) if i not in loose]
    where: list[tuple[float, float, int]] = [(float(i), 0.0, i) for i in fixed]
    for i in sorted(loose):
        spot = side.spots[i]
        number = runs * (spot.number or 0.0)
        at = bisect_left(numbers, number)
        first = sure[at - 1] if at else -1
        last = sure[at] if at < len(sure) else len(side.spots)
        between = [j for j in fixed if first < j < last]
        before = [j for j in between if side.spots[j].key < spot.key]
        where.append((max([first, *before]) + 0.5, number, i))
    return [side.spots[i] for *_, i in sorted(where)]


def _loose(spot: Spot, side: Along) -> bool:
    """Tell whether a split lot's number can place it on its side."""
    return (
        spot.split
        and spot.numbers is not None
        and (side.parity is None or spot.parity == side.parity)
    )


def _by_number(side: Sequence[Spot], rising: int) -> list[Spot]:
    """Order by house number, by lot where there is none."""
    known = sorted((one for one in side if one.numbers), key=lambda one: one.key)
    keys = [one.key for one in known]

    def place(spot: Spot) -> tuple[float, float]:
        if spot.number is not None:
            return (rising * spot.number, 0.0)
        at = bisect_left(keys, spot.key)
        if at:
            return (rising * (known[at - 1].number or 0.0), 1.0 + spot.key)
        return (rising * (known[0].number or 0.0), spot.key - 1e6)

    return sorted(side, key=place)


def doubts(side: Along, law: Law, *, by_lot: bool) -> Doubts:
    """Name the lots whose numbers do not fit their side, and why."""
    told: Doubts = []
    numbered = [one for one in side.spots if one.numbers is not None]
    halves = 2 * sum(one.parity or 0 for one in numbered) == len(numbered)
    for spot in numbered:
        if side.parity is not None and spot.parity != side.parity and len(numbered) > 1:
            others = "odd" if side.parity else "even"
            told.append((spot, f"the other numbers of its side are {others}"))
        elif halves:
            others = "even" if spot.parity else "odd"
            told.append((spot, f"half the numbers of its side are {others}"))
    told += [
        (side.spots[i], "its number is far from those beside it") for i in side.far
    ]
    if not side.agreeing or not by_lot:
        return told
    run = side.run(side.rising(law))
    out, doubtful = run.out, run.doubtful
    if not side.direction and len(side.steady) > 2:
        both = (*side.up.out, *side.up.doubtful, *side.down.out, *side.down.doubtful)
        out, doubtful = (), tuple(sorted(set(both)))
    for place in out:
        told.append(
            (side.spots[side.steady[place]], "its number runs against those beside it")
        )
    some = [side.spots[side.steady[place]] for place in doubtful]
    for spot in some:
        others = ", ".join(
            f"{one.told()} in row {one.row}" for one in some if one is not spot
        )
        told.append((spot, f"its number and those of {others} contradict each other"))
    return told
