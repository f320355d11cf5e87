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
from nostalgin_core.catalogue.runs import Run, run
from nostalgin_core.catalogue.sides import usual
from nostalgin_core.catalogue.spots import Spot, folded

AGREEING: Final = 2 / 3  # of a side's numbers, to stand by lot
TRUSTED: Final = 0.75  # of a block's
MIXED: Final = 0.25  # of a side's numbers: then both parities stand on it
FAR: Final = 40.0  # numbers: two blocks of an avenue
FARTHER: Final = 3.0  # times as far as all the rest reach

Doubts = list[tuple[Spot, str]]


@dataclass(frozen=True, slots=True, eq=False)
class Along:
    """One side, its lots in their order, and what their numbers say."""

    spots: list[Spot]  # by lot
    steady: list[int]  # places of lots whose numbers can be ordered
    run: Run  # of these
    parity: int | None  # None: both stand here, or no number is known

    @property
    def agreeing(self) -> bool:
        """Tell whether lots and numbers run together on most of the side."""
        return self.run.length >= AGREEING * len(self.steady)

    def facts(self) -> SideFacts | None:
        """Tell the street, its parity (1 odd, -1 even), and how its numbers run."""
        if not any(one.numbers for one in self.spots):
            return None
        sign = 1 if self.parity in (1, None) else -1
        length = self.run.length
        votes = self.run.direction * max(length * (length - 1) / 2, 1.0)
        return folded(self.spots[0].street), sign, votes


def along(spots: Sequence[Spot]) -> Along:
    """Find the numbers of a side that can be ordered, and how they run."""
    parity = usual(spots)
    numbered = [i for i, one in enumerate(spots) if one.numbers is not None]
    odd_ones = [i for i in numbered if spots[i].parity != parity]
    if len(odd_ones) > 1 and len(odd_ones) > MIXED * len(numbered):
        parity, odd_ones = None, []
    steady = [i for i in numbered if i not in set(odd_ones) and not spots[i].split]
    steady = steady or [i for i in numbered if i not in set(odd_ones)]
    ranges = [spots[i].numbers or (0.0, 0.0) for i in steady]
    return Along(list(spots), steady, run(ranges), parity)


def trusted(sides: Sequence[Along]) -> bool:
    """Tell whether lots and numbers agree on most of a block, so that lots can order."""
    long = [side for side in sides if len(side.steady) > 2]
    count = sum(len(side.steady) for side in long)
    return sum(side.run.length for side in long) >= TRUSTED * count


def ordered(side: Along, law: Law, *, by_lot: bool, first: bool) -> list[Spot]:
    """Order a side anticlockwise; `first` tells that a block's lots begin on it."""
    if not side.steady:
        return side.spots
    sign = 1 if side.parity in (1, None) else -1
    rising = law.get(folded(side.spots[0].street), 1) * sign
    if not by_lot or (not side.agreeing and first):
        return _by_number(side.spots, rising)
    against = first and side.run.direction not in (0, rising)
    if len(side.steady) == 2 and not side.run.direction:
        return _by_number(side.spots, rising)
    made = _with_split(side, rising if first else side.run.direction or rising)
    return made[::-1] if against else made


def _with_split(side: Along, rising: int) -> list[Spot]:
    """Put lots that were split from others between the numbers that theirs is between.

    Where lots run against the law, so do their numbers.
    """
    runs = side.run.direction or rising
    own = set(side.steady)
    out = {side.steady[place] for place in side.run.out}
    loose = [
        i for i, one in enumerate(side.spots) if i not in own and _loose(one, side)
    ]
    places = [i for i in side.steady if i not in out]
    numbers = [runs * (side.spots[i].number or 0.0) for i in places]
    highest = -float("inf")
    rising_numbers = []
    for number in numbers:  # doubtful ones may not rise
        highest = max(highest, number)
        rising_numbers.append(highest)
    where: list[tuple[float, float, int]] = [
        (float(i), 0.0, i) for i in range(len(side.spots)) if i not in set(loose)
    ]
    for i in loose:
        number = runs * (side.spots[i].number or 0.0)
        at = bisect_left(rising_numbers, number)
        behind = places[at - 1] + 0.5 if at else places[0] - 0.5
        where.append((behind, number, i))
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


def doubts(side: Along, *, by_lot: bool) -> Doubts:
    """Name the lots whose numbers do not fit their side, and why."""
    told: Doubts = []
    numbered = [one for one in side.spots if one.numbers is not None]
    for spot in numbered:
        if side.parity is not None and spot.parity != side.parity and len(numbered) > 1:
            others = "odd" if side.parity else "even"
            told.append((spot, f"the other numbers of its side are {others}"))
    if not side.agreeing or not by_lot:
        return told
    for place in side.run.out:
        told.append(
            (side.spots[side.steady[place]], "its number runs against those beside it")
        )
    pair = [side.spots[side.steady[place]] for place in side.run.doubtful]
    for spot in pair:
        others = ", ".join(one.told() for one in pair if one is not spot)
        told.append((spot, f"its number and those of {others} contradict each other"))
    return told + _far(side)


def _far(side: Along) -> Doubts:
    """Name an end of a side whose number is far from all the rest."""
    numbers = sorted(
        (side.spots[i].number or 0.0, i)
        for i in side.steady
        if i not in {side.steady[place] for place in side.run.out}
    )
    told: Doubts = []
    if len(numbers) < 3:
        return told
    for (end, i), (near, _), (other, _) in (
        (numbers[0], numbers[1], numbers[-1]),
        (numbers[-1], numbers[-2], numbers[0]),
    ):
        if abs(end - near) > max(FAR, FARTHER * abs(other - near)):
            told.append((side.spots[i], "its number is far from those beside it"))
    return told
